/* Form factors from a point to a polygon, without visibility.
 *
 * The factor F (1) is the share of the hemisphere above the point, weighted by the cosine
 * to the normal, covered by the polygon: a point under an emitter of radiosity B receives
 * the irradiance F B. The polygon is one-sided: only its front is seen, where its corners
 * are counter-clockwise. The part below the point's horizon (the plane through the point
 * at right angles to its normal) is cut off. 0 <= F <= 1, always.
 *
 * F is 0 where the point is on the polygon's plane, within rounding, or behind it.
 *
 * Error: at most 1e-9 F + 1e-15, besides the effect of rounded coordinates; a polygon
 * covering little only by its distance keeps the 1e-9. Lengths may be in any unit between
 * 1e-60 and 1e60. Source: Lambert, Photometria (1760). */
#ifndef GEOM_LAMBERT_H
#define GEOM_LAMBERT_H

#include <stdint.h>

#include "geom/triangle.h"

/* Pre: `normal` has unit length. */
double point_triangle_factor(struct vec3 x, struct vec3 normal, const struct triangle *t);

/* The same for a simple planar polygon, convex or not, of `count` >= 3 corners. */
double point_polygon_factor(struct vec3 x, struct vec3 normal, const struct vec3 *corners,
                            int32_t count);

#endif
