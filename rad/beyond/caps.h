/* Row sums of form factors, and the caps on them.
 *
 * The row sum of a leaf is its irradiance, over its links and those of its ancestors,
 * when B = 1 everywhere. The true sum is at most 1; where links of different levels meet
 * the sum may be larger. A leaf with a row sum so large that light would grow, or all but
 * grow, from bounce to bounce has its irradiance multiplied by a factor below 1, its cap.
 * So there is always a solution, and the bound on the iteration error always holds. */
#ifndef RAD_BEYOND_CAPS_H
#define RAD_BEYOND_CAPS_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/model.h"

struct caps {
    double *factor; /* [count] of the irradiance of each own leaf, above 0, at most 1 */
    int64_t count, capacity;
};

void caps_free(struct caps *caps);

/* Makes room for all patches; new ones have the factor 1. */
void caps_extend(struct caps *caps, const struct forest *forest);

/* Chooses the factor of a leaf by its row sum. */
void caps_choose(struct caps *caps, const struct forest *forest, int32_t leaf,
                 double row_sum);

enum { ROW_SUMS_ROOM = 16 };

/* Row sums over the leaves of this rank's own roots, area-weighted, in integers of
 * ROW_SUMS_ROOM of the units given to row_sums_measure(): a unit with room for the area
 * of the scene may have none for sums above 1. */
struct row_sums {
    double min, max; /* +-HUGE_VAL if there is no leaf */
    int64_t area;    /* of the leaves counted */
    int64_t rows;    /* sum of A R, R being a row sum */
    int64_t squares; /* sum of A (R - 1)^2 */
};

/* Measures row sums, after a transfer of B = 1 with the unit. Leaves of patches that
 * neither reflect nor emit are left out: they are not linked with each other. */
struct row_sums row_sums_measure(const struct forest *forest, const bool *own,
                                 struct flux_unit unit);

#endif
