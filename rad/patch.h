/* Patches: one quadtree over each root triangle.
 *
 * Every rank holds the whole forest (paper Sec. 3.1); copies of patches away from their
 * root's home are the paper's proxies. Patch number r < root_count is root r; other
 * numbers follow the order of creation, which differs from rank to rank, and never leave
 * a rank. IDs travel. */
#ifndef RAD_PATCH_H
#define RAD_PATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/scene.h"
#include "rad/id.h"

struct patch {
    int64_t flux[BANDS];    /* Phi received in this iteration over links of this very
                               patch */
    struct patch_id id;     /* global name */
    int32_t parent;         /* local number, -1 for a root */
    int32_t children;       /* local number of child 0 (1..3 follow it), 0 for a leaf */
};

/* In place of a local number: no patch, and no cluster either. */
enum { NODE_NONE = INT32_MIN };

/* True of the number of a cluster (rad/beyond/cluster.h) in the place of a patch's. */
static inline bool node_is_cluster(int32_t node)
{
    return node < 0;
}

struct forest {
    const struct scene *scene; /* borrowed */
    struct patch *patches;     /* [count] */
    struct rgb *radiosity;     /* [count] B, W/m^2; of an inner patch the mean over its
                                  leaves */
    float *ranges;             /* [ranged] largest range of a child, W/m^2; NULL: there
                                  are none; see rad/beyond/range.h */
    struct rgb *above;         /* [root_count] irradiance handed down by clusters to each
                                  root, W/m^2; NULL: no clusters */
    double *caps;              /* [count] factor of the irradiance of each leaf, 1; NULL:
                                  there are none; see rad/beyond/conjugate.h */
    int64_t count, capacity, radiosity_capacity, ranged;
    int32_t root_count;
};

/* The forest of undivided roots, each with its emission as radiosity. */
struct forest *forest_create(const struct scene *scene);
void forest_destroy(struct forest *forest);

static inline bool patch_is_leaf(const struct patch *patch)
{
    return patch->children == 0;
}

/* Child k of a patch, or NODE_NONE. */
static inline int32_t forest_child(const struct forest *forest, int32_t patch, int k)
{
    int32_t first = forest->patches[patch].children;
    return first > 0 ? first + k : NODE_NONE;
}

/* Gives a leaf four children with its radiosity and no flux; does nothing to an inner
 * patch. May move `patches`. Pre: its level is below ID_MAX_LEVEL. */
void forest_split(struct forest *forest, int32_t patch);

/* Local number of the patch with this ID; missing ones on the way there are created. Pre:
 * id_is_valid(id) and id.root < root_count. */
int32_t forest_reach(struct forest *forest, struct patch_id id);

/* Corners, recomputed from the root. Scene units. */
struct triangle forest_triangle(const struct forest *forest, int32_t patch);

/* Area, square scene units: the root's times 4^-level, so children add up exactly. */
static inline double forest_area(const struct forest *forest, int32_t patch)
{
    struct patch_id id = forest->patches[patch].id;
    double share = 1.0 / (double)(UINT32_C(1) << (2 * id_level(id)));
    return scene_root_area(forest->scene, (int32_t)id.root) * share;
}

static inline const struct material *forest_material(const struct forest *forest,
                                                     int32_t patch)
{
    return scene_root_material(forest->scene, (int32_t)forest->patches[patch].id.root);
}

/* Numbers under all roots with an area. */
struct forest_counts {
    int64_t patches, leaves;
};

struct forest_counts forest_count(const struct forest *forest);

/* The local numbers of all patches, roots in order and each tree depth first: as a
 * sequence of IDs the same on all ranks with the same trees. [count], to be freed with
 * alloc_free(). */
int32_t *forest_order(const struct forest *forest);

/* The next patch of root `root` depth first, children in order: start with patch = root,
 * ends with -1. `descend` false skips what is below `patch`. */
int32_t forest_next(const struct forest *forest, int32_t patch, bool descend);

/* The leaf after `leaf`, in the same order, of the roots with an area: start with
 * leaf = -1, ends with -1. */
int32_t forest_next_leaf(const struct forest *forest, int32_t leaf);

/* A hash of all trees and of the radiosities of their leaves, roots in order: the same
 * on any number of ranks and on any machine. */
uint64_t forest_checksum(const struct forest *forest);

#endif
