/* The tree above the roots: the quadtrees of the patches, continued upwards to one node,
 * the top, over the whole scene.
 *
 * A cluster is a node of this tree: up to four children, each a cluster or a root. The
 * tree is a pure function of the prepared scene, the same on all ranks and machines; one
 * copy serves all ranks of a node.
 *
 * A node is a patch or a cluster: number n >= 0 is patch n, number n < 0 is cluster ~n.
 * As an ID a cluster has CLUSTER_ROOT for its root, and its path from the top as a patch
 * has its from a root. */
#ifndef RAD_BEYOND_CLUSTER_H
#define RAD_BEYOND_CLUSTER_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/pack.h"
#include "geom/scene.h"
#include "rad/beyond/spaces.h"
#include "rad/patch.h"

/* The top is cluster 0. Ask for NODE_NONE first, which is below 0, too. */
enum { NODE_TOP = -1 };

/* No root has this number. */
#define CLUSTER_ROOT UINT32_MAX

struct cluster {
    struct vec3 low, high;               /* box around its roots, scene units */
    struct vec3 normal_low, normal_high; /* box around their unit normals */
    double area;                         /* sum over its roots, square scene units */
    double reflecting;                   /* area of surfaces not black */
    struct rgb reflectance;              /* mean over these, 1: a house on a wide black
                                            ground does not look black */
    int32_t child[4];                    /* nodes; NODE_NONE where there are fewer */
    int32_t first, end; /* its roots are roots[first] to before roots[end] */
    uint32_t hierarchy;                  /* of its ID */
    int32_t space;                       /* of its roots; -1: of several */
    bool is_dark;                        /* none of its roots reflects or emits */
};

struct cluster_tree {
    struct cluster *clusters; /* [count] children after their parents */
    int32_t *roots; /* [root_count] those with an area, in the tree's order */
    int32_t *place; /* [all roots] where a root is in `roots`; -1: no area */
    double *area_before;      /* [root_count + 1] sum over the roots before a place */
    int32_t count, root_count, all_roots;
    bool is_view;             /* the arrays lie in memory of others */
};

/* The tree over all roots with an area; at least one has. O(k log k) for k roots. */
struct cluster_tree *cluster_tree_build(const struct scene *scene,
                                        const struct spaces *spaces);
void cluster_tree_destroy(struct cluster_tree *tree);

/* Into a block, and as found there: read-only, valid as long as the block. */
void cluster_tree_pack(const struct cluster_tree *tree, struct pack *pack);
struct cluster_tree *cluster_tree_view(struct pack *pack);

/* Area of a root or a cluster, square scene units. */
static inline double cluster_node_area(const struct cluster_tree *tree,
                                       const struct scene *scene, int32_t node)
{
    return node_is_cluster(node) ? tree->clusters[~node].area
                                 : scene_root_area(scene, node);
}

/* The cluster with this path from the top, or NODE_NONE. Pre: id_is_valid(). */
int32_t cluster_reach(const struct cluster_tree *tree, uint32_t hierarchy);

#endif
