/* Segments from a receiver to the senders of its cut. */
#ifndef RAD_BEYOND_GATHER_AIM_H
#define RAD_BEYOND_GATHER_AIM_H

#include "rad/beyond/gather/receiver.h"

/* Adds the light of lamps, by segments, and light behind panes aimed at. */
void receiver_aim(struct receiver *r);

/* Adds the light of bright patches, by as many segments as a part of its rays. */
void receiver_aim_at_bright(struct receiver *r);

#endif
