/* Push-pull: bringing a tree with flux at all levels into a consistent state (paper Sec. 2.2). */
#ifndef RAD_PUSHPULL_H
#define RAD_PUSHPULL_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/method.h"

/* What one push-pull did to this rank's own roots. Powers in units of method.flux_unit, summed
 * over bands, so that ranks can add them. */
struct push_pull_sums {
    int64_t light;    /* sum over leaves of A B */
    int64_t absorbed; /* sum over leaves of A (1 - rho) H */
    int64_t change;   /* sum over leaves of A |B - B of the iteration before| */
    double shrink;    /* largest factor from the change before to that now of an unsettled root */
    bool diverged;    /* a flux reached FLUX_LIMIT */
};

/* Row sums of the form factors over the leaves of this rank's own roots, area-weighted; sums in
 * the unit given to closure_measure(). */
struct closure_sums {
    double min, max; /* +-HUGE_VAL where there is no leaf */
    int64_t area;    /* of the leaves counted */
    int64_t rows;    /* sum of A R */
    int64_t squares; /* sum of A (R - 1)^2 */
};

/* Irradiance H of a leaf, W/m^2: the flux of the leaf and of all above it, each over its area. */
struct rgb leaf_irradiance(const struct forest *forest, int32_t leaf, struct flux_unit unit);

/* Push and pull on the roots with own[root] set: leaves get B = E + rho H, inner patches the
 * mean of their children. Sets touched[root] where a leaf's B changed. root_change[root] holds
 * each own root's change of the iteration before, and is renewed. */
struct push_pull_sums push_pull(const struct method *method, const bool *own, bool *touched,
                                int64_t *root_change);

/* The pull alone, on all roots: inner patches get the mean of their children. */
void forest_pull(struct forest *forest);

/* Sets the flux of all patches to 0. */
void forest_clear_flux(struct forest *forest);

/* Row sums, after links_transfer_ones() with the same unit. Leaves of patches that neither
 * reflect nor emit are left out: they are not linked with each other. */
struct closure_sums closure_measure(const struct forest *forest, const bool *own,
                                    struct flux_unit unit);

/* A unit for areas in links_transfer_ones(): the scene's area 16 times over is the limit. */
struct flux_unit closure_unit(const struct scene *scene);

#endif
