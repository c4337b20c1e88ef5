/* Conjugate residuals: fewer of the paper's iterations to the same light; and caps, for a
 * finite light in any scene.
 *
 * The row sum of a leaf (rad/pushpull.h) is at most 1 in truth; where links of different
 * levels meet, larger sums occur. A leaf with a row sum so large that light would grow,
 * or all but grow, from bounce to bounce has its irradiance multiplied by a factor below
 * 1, its cap.
 *
 * Collective: each rank changes the light of its own leaves, and sums go over all. */
#ifndef RAD_BEYOND_CONJUGATE_H
#define RAD_BEYOND_CONJUGATE_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/beyond/spaces.h"
#include "rad/beyond/total.h"
#include "rad/flux.h"
#include "rad/patch.h"

struct conjugate {
    int32_t *leaves;       /* [count] reflecting ones of this rank */
    struct rgb *weight;    /* w, square scene units; [count], like the others leaf by
                              leaf */
    struct rgb *radiosity; /* B, W/m^2 */
    struct rgb *residual;  /* r = G(B) - B */
    struct rgb *direction; /* p */
    struct rgb *image;     /* K p */
    double *terms;         /* [2 * BANDS * count] room for those of sums */
    int64_t count;
    struct totals totals;
    double growth;         /* largest cap times row sum times reflectance, below 1 */
    double share;          /* largest cap times reflectance */
    bool begun;            /* r is known */
};

void conjugate_free(struct conjugate *cg);

/* Chooses the caps of the leaves of own roots, own[root], and begins with the radiosities
 * of the forest, which the next iteration is of. Pre: the flux of the forest, in the
 * unit, is of B = 1 in the first band: irradiances are row sums. */
void conjugate_begin(struct conjugate *cg, struct forest *forest, const bool *own,
                     struct flux_unit unit, struct totals totals);

/* A bound on the light missing in the radiosities after an iteration, W in square scene
 * units; that of a dim space counts as often as the brightest has more light. `spaces`:
 * NULL for one. */
double conjugate_missing(const struct conjugate *cg, const struct forest *forest,
                         const struct spaces *spaces);

/* After an iteration: sets the radiosities of own leaves for the next one. */
void conjugate_step(struct conjugate *cg, struct forest *forest);

#endif
