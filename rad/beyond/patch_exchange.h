/* Form factors of pairs of patches, phr's: from points to the whole other patch, with the
 * parts of the children of either side; and proofs of visibility.
 *
 * As in rad/formfactor.h, the exchange area is G = A_p F_pq = A_q F_qp. 0 <= G <=
 * min(A_p, A_q), always. */
#ifndef RAD_BEYOND_PATCH_EXCHANGE_H
#define RAD_BEYOND_PATCH_EXCHANGE_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/formfactor.h"
#include "rad/model.h"

/* Tests taking about as long: prices.c. Of patches near each other three times as many,
 * as there are three times the points. These numbers predict the seconds of a level
 * within 7 to 11 %, RMS (100 for all pairs: 20 to 27). */
enum { TESTS_PER_EXCHANGE = 50 };

struct exchange {
    double area;       /* G with visibility */
    double unoccluded; /* an estimate of G without blockers, >= area */
    double seen;       /* share of the arriving segments, weighted, 1 */
    bool apart;        /* far enough apart for their size to trust G from points */
    double parts_p[4]; /* the parts of G of the four children of p: sum 1 */
    double parts_q[4]; /* the parts of G of the four children of q: sum 1 */
};

/* Knowledge of the visibility of a pair, before segments are asked. */
struct visibility {
    bool open;       /* proved: nothing can stand between the patches */
    int32_t blocker; /* in and out: as *guess of octree_block() */
};

/* True where each facet has a corner in front of the other: exact, so a pair not facing
 * exchanges no light at all. */
bool facets_face(const struct facet *p, const struct facet *q);

/* The exchange of a pair: visibility from segments between sub-areas facing each other,
 * unless known; form factors from points to the whole other patch: one for each sub-area,
 * or three where the patches are not apart. Pre: facets_face(p, q). */
struct exchange exchange_estimate(const struct facet *p, const struct facet *q,
                                  const struct octree *octree,
                                  struct visibility *visibility,
                                  struct octree_counts *counts);

/* Proves that nothing of one facet sees anything of the other: true if one wall stops all
 * nine segments between their corners. */
bool facets_are_walled_off(const struct facet *p, const struct facet *q,
                           const struct octree *octree, struct octree_counts *counts);

/* True if all of one facet is proved to see all of the other, as far as the two face. */
bool facets_are_open(const struct facet *p, const struct facet *q,
                     const struct octree *octree, struct octree_counts *counts);

#endif
