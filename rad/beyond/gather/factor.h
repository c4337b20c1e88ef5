/* Factors from a triangle to another, nothing in the way. */
#ifndef RAD_BEYOND_GATHER_FACTOR_H
#define RAD_BEYOND_GATHER_FACTOR_H

#include <stdint.h>

#include "geom/triangle.h"

typedef double triangle_factor(const struct triangle *from, struct vec3 normal,
                               const struct triangle *to, int64_t *work);

/* The factor (1) from a triangle with this unit normal to another, unoccluded: the mean
 * over points of the first, the more the nearer the other is. Source: Lambert, exact at
 * each point. Adds the worth of the points in tests to `work`. */
triangle_factor mean_factor;

/* The same, in closed form if the other is near. Pre: the first has an area. */
triangle_factor near_factor;

#endif
