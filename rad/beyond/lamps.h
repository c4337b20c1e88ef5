/* Lamps: roots that emit, and that rays in all directions would find too seldom for the
 * light that they bring. A final gather aims at them, and at bright patches, which are
 * lamps by the light that they reflect: roots, or the parts of a wall beside a lamp. */
#ifndef RAD_BEYOND_LAMPS_H
#define RAD_BEYOND_LAMPS_H

#include "rad/beyond/node.h"

/* A node whose lamps count as one, as seen from a leaf. */
struct lamp_group {
    int32_t node;  /* a cluster or a root; a bright patch, or one with some below it */
    double direct; /* irradiance of the leaf, about, over all bands, unoccluded, W/m^2 */
    double worth;  /* the same, less where that is more than may arrive, W/m^2 */
    double seen;   /* share of its light that is seen from around the leaf; 1 where that
                      is not asked */
};

struct lamp_groups {
    struct lamp_group *items; /* [count] */
    int64_t count, capacity;
    double worth;             /* sum */
};

/* A cluster that has lamps, as a leaf asks for it. */
struct lit_cluster {
    int32_t node;
    int32_t child[4]; /* those that have lamps: roots, or ~number of a lit cluster;
                         NODE_NONE where there are fewer */
    double watts;     /* power of its lamps, W in square scene units */
    struct vec3 middle, normal_low, normal_high; /* of boxes, as in struct cluster */
    double radius;    /* of a ball around the box */
};

struct lamps {
    const struct model *model; /* borrowed */
    double least;   /* a lamp sends more than this, summed over bands, W/m^2 */
    bool reflect;   /* bright patches: they send reflected light, and no emission */
    bool alike;     /* all send the same, so that their light tells their form factor */
    double *sent;   /* [roots] sent by a lamp, over all bands, W/m^2; by others 0 */
    double *before; /* [tree->root_count + 1] power of the lamps before a place in the
                       tree's order, over all bands, W in square scene units */
    double *power;  /* [patches] if `reflect`: that of the bright patches which a patch
                       is, or has below it; NULL if not */
    int32_t *part_of; /* [patches] the bright patch that a patch is, or is part of; -1:
                         none; as `power` in roots with an area, NULL if not `reflect` */
    double part;    /* of all reflected light that bright patches send, 1 */
    struct lit_cluster *lit; /* [lit_count] parents first; the first is the top */
    int64_t lit_count, lit_capacity;
    struct lamp_groups groups; /* of the leaf at hand */
};

/* A lamp that was chosen. */
struct lamp {
    int32_t patch; /* a root; of bright patches one of these; -1: none */
    double share;  /* the inverse of its chance, 1: of a group, the power of all of its
                      lamps over its own */
};

/* Borrows the model, which has clusters, and a solution if `reflect`. A lamp sends more
 * than `least`, over all bands: emission, or if `reflect`, reflected light. */
struct lamps lamps_create(const struct model *model, double least, bool reflect);
void lamps_free(struct lamps *lamps);

/* The roots of a node: places in the tree's order. */
void lamps_places(const struct lamps *lamps, int32_t node, int32_t *first, int32_t *end);

/* The light that a lamp sends, W/m^2. */
struct rgb lamp_light(const struct lamps *lamps, int32_t patch);

/* The power that all lamps send, over all bands, W in square scene units. */
double lamps_power(const struct lamps *lamps);

static inline bool root_is_lamp(const struct lamps *lamps, int32_t root)
{
    return lamps->sent[root] > 0.0;
}

/* Finds the groups of lamps that a leaf tells apart by so many segments, in the tree's
 * order: each is a root, or a cluster that is small for its distance and would get about
 * one segment at most, a sixteenth of one if some of its lamps may face away. All lamps
 * of a node of the tree below its top are worth no more than `most` to it, W/m^2; then a
 * quarter of all worth is shared by direct light. Adds the tests that it took to
 * `work`. */
void lamps_group(struct lamps *lamps, const struct facet *leaf, int segments,
                 double most, int64_t *work);

/* The place of choice k of `count` in the order of what is chosen from: the first half
 * takes every other place, the second the rest, so that both are spread evenly. */
static inline int lamp_place(int k, int count)
{
    return 2 * k < count ? 2 * k : (2 * k - count) | 1;
}

/* A lamp of the group, by the power that it emits; `u` in [0, 1) chooses. */
struct lamp lamp_choose(const struct lamps *lamps, int32_t node, double u);

/* A lamp for a point x of a surface with this unit normal, by the light that it would
 * bring without blockers, about, on the way down the tree from its top; no node counts
 * with more than `most`, W/m^2. `u` in [0, 1) chooses. None: no lamp can be seen from x.
 * Pre: not `reflect`. */
struct lamp lamp_choose_at(const struct lamps *lamps, struct vec3 x, struct vec3 normal,
                           double most, double u);

/* The factor (1) from a triangle with this unit normal to another, unoccluded: the mean
 * over points of it, which are the more the nearer the other is. Source: Lambert, exact
 * at each point. Adds the tests that points are worth to `work`. */
double mean_factor(const struct triangle *from, struct vec3 normal,
                   const struct triangle *to, int64_t *work);

/* The same, in closed form if the other is near. Pre: the first has an area. */
double near_factor(const struct triangle *from, struct vec3 normal,
                   const struct triangle *to, int64_t *work);

/* True if surfaces with these unit normals face each other, across a gap that is narrow
 * beside one of this area: its width is less than a fifth of the area's square root. */
static inline bool gap_is_narrow(struct vec3 normal, struct vec3 other, double width,
                                 double area)
{
    return vec3_dot(normal, other) < -0.7 && width * width < 0.04 * area;
}

#endif
