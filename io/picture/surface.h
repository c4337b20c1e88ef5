/* Which roots are one smooth surface, over which shading may blend. */
#ifndef IO_PICTURE_SURFACE_H
#define IO_PICTURE_SURFACE_H

#include <stdint.h>

#include "geom/scene.h"

/* surface[root]: a number that all roots of one smooth surface share: roots of one material that
 * meet in whole edges where their planes agree within 2.5 degrees or the normals that the scene
 * gives agree so at both ends. To be freed with alloc_free(). */
int32_t *surface_of_roots(const struct scene *scene);

#endif
