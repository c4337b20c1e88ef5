/* A light meter: the irradiance at a point, of any surface or of none. */
#ifndef RAD_BEYOND_METER_H
#define RAD_BEYOND_METER_H

#include <stdint.h>

#include "octree/octree.h"
#include "rad/beyond/panes.h"

struct meter {
    const struct forest *forest;  /* borrowed: its scene with a solution */
    const struct octree *octree;  /* borrowed */
    const float *error;           /* [patches] borrowed: of B of leaves, W/m^2; or NULL */
    struct panes *panes;          /* owned; NULL: none */
    int32_t *lamps;               /* [lamp_count] roots, those of a sky, too */
    int64_t lamp_count;
    double *shares;               /* [lamp_count] room for the light of each at a point */
    double height;                /* of a point above its surface, scene units */
    struct octree_counts *counts; /* of rays so far; owned */
};

struct metered {
    struct rgb irradiance; /* W/m^2 */
    struct rgb lamps;      /* the part straight from lamps and a sky, W/m^2 */
    double error;          /* bound on the error of a band, for 95 % of points, W/m^2 */
};

struct meter meter_make(const struct forest *forest, const struct octree *octree,
                        const float *error);
void meter_free(struct meter *meter);

/* Returns the irradiance at x, scene units, by about this many rays, and as many segments
 * to lamps; 8 of each at least. `normal` has length 1. The same on every rank. */
struct metered meter_read(const struct meter *meter, struct vec3 x, struct vec3 normal,
                          int rays, uint64_t seed);

#endif
