/* Rays from a receiver in all directions. */
#ifndef RAD_BEYOND_GATHER_RAYS_H
#define RAD_BEYOND_GATHER_RAYS_H

#include "rad/beyond/gather/receiver.h"

/* Adds the rest of the light, by rays. Pre: receiver_aim() has been called. */
void receiver_fire(struct receiver *r);

#endif
