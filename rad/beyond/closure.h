/* Row sums of form factors, and the caps on them.
 *
 * The row sum of a leaf is its irradiance, over its links and those of its ancestors, when
 * B = 1 everywhere: at most 1 in truth. Where links of different levels meet it comes out
 * otherwise. A leaf whose row sum is so large that light would grow, or all but grow, from
 * bounce to bounce receives a factor less. So there is always a solution, and the bound on
 * the iteration error always holds. */
#ifndef RAD_BEYOND_CLOSURE_H
#define RAD_BEYOND_CLOSURE_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/model.h"

struct closure {
    double *factor; /* [count] of the irradiance of each own leaf, at most 1 */
    int64_t count, capacity;
};

void closure_free(struct closure *closure);

/* Makes room for all patches; new ones have the factor 1. */
void closure_extend(struct closure *closure, const struct forest *forest);

/* Chooses the factor of a leaf by its row sum. */
void closure_cap(struct closure *closure, const struct forest *forest, int32_t leaf,
                 double row);

enum { CLOSURE_ROOM = 16 };

/* Row sums of the form factors over the leaves of this rank's own roots, area-weighted. The sums
 * count in CLOSURE_ROOM of the units given to closure_measure(): a unit that has room for the area
 * of the scene may have none for rows that sum to more than 1. */
struct closure_sums {
    double min, max; /* +-HUGE_VAL where there is no leaf */
    int64_t area;    /* of the leaves counted */
    int64_t rows;    /* sum of A R */
    int64_t squares; /* sum of A (R - 1)^2 */
};

/* Row sums, after a transfer of B = 1 with the unit. Leaves of patches that neither reflect nor
 * emit are left out: they are not linked with each other. */
struct closure_sums closure_measure(const struct forest *forest, const bool *own,
                                    struct flux_unit unit);

#endif
