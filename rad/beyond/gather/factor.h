/* Factors from a triangle to another, nothing in the way. */
#ifndef RAD_BEYOND_GATHER_FACTOR_H
#define RAD_BEYOND_GATHER_FACTOR_H

#include <stdint.h>

#include "geom/triangle.h"

typedef double triangle_factor(const struct triangle *from, struct vec3 normal,
                               const struct triangle *to, int64_t *work);

/* Returns the form factor from a triangle with this unit normal to another, nothing in
 * the way, 1: the mean over points of the first. Near triangles get more points; two
 * across a narrow gap get the closed form. Source: Lambert, exact at each point. Adds the
 * worth of the points in tests to `work`. */
triangle_factor mean_factor;

/* Does the same, in closed form wherever the other is near. Pre: the first has an
 * area. */
triangle_factor near_factor;

#endif
