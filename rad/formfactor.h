/* Form factors of pairs of patches, with visibility (paper Eq. 2 and Fig. 2).
 *
 * The exchange area G = A_p F_pq = A_q F_qp, square scene units, is computed: one number
 * for both directions, so reciprocity is exact. 0 <= G <= min(A_p, A_q), always. */
#ifndef RAD_FORMFACTOR_H
#define RAD_FORMFACTOR_H

#include <stdint.h>

#include "octree/octree.h"
#include "rad/patch.h"

/* One patch of a pair. */
struct facet {
    struct triangle triangle;
    struct plane plane;
    double area;
    int32_t input; /* input triangle of the facet */
};

struct facet facet_make(const struct forest *forest, int32_t patch);

/* A pair, cut into four sub-areas on either side. Segment 4 a + b joins sub-area a of p
 * with sub-area b of q. */
struct facet_pair {
    const struct facet *p, *q;   /* borrowed */
    double kernels[BUNDLE_RAYS]; /* exchange areas of the sub-areas, if nothing is in
                                    the way */
    struct bundle bundle;        /* the segments; asked: those whose ends face each
                                    other */
};

struct facet_pair facet_pair_make(const struct facet *p, const struct facet *q);

/* The exchange area of two small areas at x and y, by the disk, if nothing is in the
 * way; 0 below a horizon. */
double disk_exchange(struct vec3 x, struct vec3 normal_x, double area_x, struct vec3 y,
                     struct vec3 normal_y, double area_y);

/* G of a pair by Eq. 2 and 16 rays. `*blocker` is the guess of octree_block(); `*seen`
 * becomes the share of arriving rays, 0 to 1. */
double exchange_area(const struct facet *p, const struct facet *q,
                     const struct octree *octree,
                     int32_t *blocker, double *seen, struct octree_counts *counts);

#endif
