/* Polygons of the input: cutting them into triangles. */
#ifndef GEOM_POLYGON_H
#define GEOM_POLYGON_H

#include <stdint.h>

#include "geom/vec.h"

/* Cuts a simple polygon of `count` >= 3 corners, convex or not, planar or nearly so, into
 * count - 2 triangles without new vertices and writes 3 corner numbers (0..count-1) for
 * each into `triangles`. A convex polygon without straight corners becomes the fan from
 * corner 0. A polygon crossing itself still gives count - 2 triangles. */
void polygon_triangulate(const struct vec3 *corners, int32_t count, int32_t *triangles);

#endif
