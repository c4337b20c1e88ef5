/* Looks at leaves, before rows are made. */
#ifndef RAD_BEYOND_GATHER_LOOK_H
#define RAD_BEYOND_GATHER_LOOK_H

#include "rad/beyond/gather/gather.h"

/* A look at a leaf: the light of its quarters by a few rays, in the same directions. */
struct gather_look {
    float reflected[4][BANDS]; /* rho H of each quarter, W/m^2 */
    double noise;              /* variance by chance of rho H of a quarter, around the
                                  mean of all four */
    double variance;           /* of rho H of a ray with its segment, over bands,
                                  (W/m^2)^2 */
    double of_segment;         /* the segment's part of `variance` */
    float fixed;               /* tests of a quarter, without its rays */
    float work;                /* tests of each ray */
    bool cut;                  /* a thing stands on the leaf */
};

/* Looks at the quarters of a leaf, by `rays` rays each. */
struct gather_look final_gather_look(struct final_gather *gather, int32_t leaf, int rays);

#endif
