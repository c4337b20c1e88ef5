/* Segments to lamps: what blocks them, and one from a point of a path. */
#ifndef RAD_BEYOND_GATHER_SOURCE_H
#define RAD_BEYOND_GATHER_SOURCE_H

#include "rad/beyond/gather/receiver.h"

/* The triangle blocking the segment from a point of the receiver to one of a root, or
 * -1. */
int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root);

/* A point of a sender. */
struct sender_point {
    int32_t root;
    struct vec3 at;
    double share; /* form factor of the sender over the probability of its choice, 1 */
};

/* Chooses a sender for the point x of a path, by the cut of its patch, and a point of the
 * sender above the horizon of x, by hashes. False if the point is not visible, or its
 * light is brought by a pane on the way. */
bool receiver_choose_beside(struct receiver *r, struct cuts *cuts, struct vec3 x,
                            struct vec3 normal, int32_t patch, uint64_t seed,
                            struct sender_point *target);

/* Adds `weight` times the light of one lamp at the point x of a path on this patch. */
void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed);

#endif
