/* Push-pull: bringing a tree with flux at all levels into a consistent state (paper
 * Sec. 2.2). */
#ifndef RAD_PUSHPULL_H
#define RAD_PUSHPULL_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/model.h"

/* What one push-pull did to this rank's own roots. Powers in units of model.flux_unit,
 * summed over bands, to be added by ranks. */
struct push_pull_sums {
    int64_t light;    /* sum over leaves of A B */
    int64_t absorbed; /* sum over leaves of A (1 - rho) H */
    int64_t arriving; /* sum over leaves of A H */
    int64_t leaves;   /* their number */
    int64_t change;   /* sum over leaves of A |B - B of the iteration before| */
};

/* Irradiance H of a leaf, W/m^2: the flux of the leaf and of all patches above, each over
 * its area. */
struct rgb leaf_irradiance(const struct forest *forest, int32_t leaf,
                           struct flux_unit unit);

/* Push and pull on these patches, whole trees, parents before children: leaves get
 * B = E + rho H, inner patches the mean of their children. `flux`: unit of the flux. */
struct push_pull_sums push_pull(const struct model *model, struct flux_unit flux,
                                const int32_t *patches, int64_t count);

/* The pull alone, of one patch in a vector [forest->count]: an inner patch gets the mean
 * of its children. */
void patch_average(const struct forest *forest, int32_t patch, struct rgb *vector);

/* The pull of the radiosities of these patches, parents before children, and of all. */
void patches_average(struct forest *forest, const int32_t *patches, int64_t count);
void forest_average(struct forest *forest);

enum { ROW_SUMS_ROOM = 16 };

/* Row sums of the leaves of own roots. The row sum R of a leaf is its irradiance, over
 * its links and those of its ancestors, when B = 1 everywhere. Sums are integers of
 * ROW_SUMS_ROOM of the units given to row_sums_measure(): a unit with room for the area
 * of the scene may have none for sums above 1. */
struct row_sums {
    double min, max; /* +-HUGE_VAL if there is no leaf */
    int64_t area;    /* of the leaves counted */
    int64_t rows;    /* sum of A R */
    int64_t squares; /* sum of A (R - 1)^2 */
};

/* Measures row sums, after a transfer of B = 1 with the unit. Leaves of patches that
 * neither reflect nor emit are left out: no links among these. */
struct row_sums row_sums_measure(const struct forest *forest, const bool *own,
                                 struct flux_unit unit);

#endif
