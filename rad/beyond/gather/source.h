/* Segments to lamps: what blocks them, and one from a point of a path. */
#ifndef RAD_BEYOND_GATHER_SOURCE_H
#define RAD_BEYOND_GATHER_SOURCE_H

#include "rad/beyond/gather/receiver.h"

/* The triangle blocking the segment from a point of the receiver to one of a root, or
 * -1. */
int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root);

/* Adds `weight` times the light of one lamp at a point x of a patch beside the leaf, and
 * of one lamp behind a pane. */
void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed);

#endif
