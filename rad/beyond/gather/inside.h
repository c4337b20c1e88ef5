/* Whether a ray begins inside of a thing: a solid with the backs of its faces inside. */
#ifndef RAD_BEYOND_GATHER_INSIDE_H
#define RAD_BEYOND_GATHER_INSIDE_H

#include "rad/model.h"

/* Faces in one place are less far apart, in scene units. */
#define FACES_APART 0x1p-26

/* True if a ray may begin inside of a thing. Such a ray leaves more things than it
 * enters: through a back, or through a wall that a face of the thing lies on, whose front
 * it meets. Where the thing has no face there, a second ray, straight across from the
 * wall, does. `single` becomes true if one of the two rays comes to a back with no front
 * in its place: where all walls are double nothing tells the inside of a box from a room.
 * Faces with two sides bound nothing. Points in scene units; `direction` has length 1. */
bool ray_is_bound(struct model *model, struct vec3 origin, struct vec3 direction,
                  bool *single);

#endif
