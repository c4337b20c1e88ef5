/* Caps on the row sums of form factors.
 *
 * The true row sum of a leaf (rad/pushpull.h) is at most 1; where links of different
 * levels meet the sum may be larger. A leaf with a row sum so large that light would
 * grow, or all but grow, from bounce to bounce has its irradiance multiplied by a factor
 * below 1, its cap. So there is always a solution, and the bound on the iteration error
 * always holds. */
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

#endif
