/* Panes on the way of a receiver's rays and segments. For the files of the final gather
 * alone. */
#ifndef RAD_BEYOND_GATHER_PANE_H
#define RAD_BEYOND_GATHER_PANE_H

#include "rad/beyond/gather/met.h"

/* The way of a ray from `origin`, to the front or back that it meets, or without end; and
 * of a segment. For the functions below alone: any, where there are no panes. */
struct pane_walk receiver_walk(struct receiver *r, struct vec3 origin,
                               struct vec3 direction, enum met met,
                               const struct point *point);
struct pane_walk receiver_walk_to(const struct receiver *r, struct vec3 from,
                                  struct vec3 to);

/* True if a pane aimed at, other than `but`, brings the light of this way. `but`: a root,
 * or -1. */
bool receiver_puts_aside(struct receiver *r, struct pane_walk walk, int32_t but);

/* Multiplies the weight of light by the transmittances of all panes on its way. */
void receiver_filter(struct receiver *r, struct pane_walk walk, struct rgb *weight);

/* Does the same, and adds the light that each pane reflects itself. */
void receiver_cross(struct receiver *r, struct pane_walk walk, struct rgb *weight);

#endif
