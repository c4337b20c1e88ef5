/* The row of a leaf, made; the light at points. */
#ifndef RAD_BEYOND_GATHER_ROW_H
#define RAD_BEYOND_GATHER_ROW_H

#include "rad/beyond/gather/gather.h"

/* The mean irradiance of points, W/m^2. */
struct gather_light {
    struct rgb straight; /* emission straight from lamps */
    struct rgb rest;  /* all other light; 0 unless asked for */
    struct rgb variance; /* of both, if segments and rays were chosen by chance,
                            (W/m^2)^2 */
    struct rgb halves;   /* a sample of the variance by the sequence: see struct
                            gather_row */
};

/* Appends the row of a leaf, made by `rays` rays, and `segments` to lamps; or, if `exact`
 * and its root is open, by exact factors. */
void final_gather_add_row(struct final_gather *gather, int32_t leaf, int rays,
                          int segments, bool exact);

/* Returns the light at points, for the radiosities of the forest: by `count` segments to
 * lamps, and, if `all`, `count` rays for the rest. */
struct gather_light final_gather_at(struct final_gather *gather,
                                    const struct gather_points *points, uint64_t seed,
                                    int count, bool all);

#endif
