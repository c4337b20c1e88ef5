/* Smooth surfaces: sets of roots over which shading interpolates. */
#ifndef IO_PICTURE_SURFACE_H
#define IO_PICTURE_SURFACE_H

#include <stdint.h>

#include "geom/scene.h"

/* Returns surface[root], the number of the smooth surface of each root: roots of one
 * material meeting in whole edges, where their planes agree within 2.5 degrees, or the
 * normals of the scene agree so at both ends. To be freed with alloc_free(). */
int32_t *surface_of_roots(const struct scene *scene);

#endif
