/* Form factors of pairs of patches, with visibility (paper Eq. 2 and Fig. 2).
 *
 * What is computed is the exchange area G = A_p F_pq = A_q F_qp, square scene units: one number
 * for both directions, so reciprocity is exact. 0 <= G <= min(A_p, A_q), always. */
#ifndef RAD_FORMFACTOR_H
#define RAD_FORMFACTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/method.h"

struct exchange {
    double area;       /* G with visibility */
    double unoccluded; /* an estimate of what G would be without blockers, >= area */
};

/* One patch of a pair, as the kernel needs it. */
struct facet {
    struct triangle triangle;
    struct plane plane;
    double area;
    int32_t input; /* input triangle that it lies on */
};

struct facet facet_make(const struct forest *forest, int32_t patch);

/* True where each facet has a corner in front of the other: exact, so a pair that is not
 * facing exchanges no light at all. */
bool facets_face(const struct facet *p, const struct facet *q);

/* The 16-ray disk: both patches in 4 sub-areas, one ray for each pair of sub-areas that face
 * each other. `*guess` is as in octree_block(). Pre: facets_face(p, q). */
struct exchange exchange_by_disks(const struct facet *p, const struct facet *q,
                                  const struct octree *octree, int32_t *guess,
                                  struct octree_counts *counts);

/* True if it is proved that nothing of one facet sees anything of the other: one triangle stops
 * all nine segments between their corners. */
bool facets_are_walled_off(const struct facet *p, const struct facet *q,
                           const struct octree *octree, struct octree_counts *counts);

#endif
