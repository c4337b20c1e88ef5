/* A uniform sky around a scene. */
#ifndef IO_SCENE_SKY_H
#define IO_SCENE_SKY_H

#include "geom/scene.h"

/* Adds a sky of this radiosity, W/m^2, to a scene not prepared yet: a dome of facets, far
 * away, shining inwards, down to the height of the lowest point. The facets have the last
 * numbers of the input triangles. */
void sky_add(struct scene *scene, struct rgb radiosity);

#endif
