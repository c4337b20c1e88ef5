/* Points of a low-discrepancy sequence, and their images on triangles and hemispheres. */
#ifndef RAD_BEYOND_SEQUENCE_H
#define RAD_BEYOND_SEQUENCE_H

#include <stdint.h>

#include "geom/triangle.h"

/* A sequence of points in the unit cube of four dimensions: the first 2^k points fill the
 * cube evenly (Sobol), and those of different seeds are independent (Owen's
 * scrambling). */
enum { SEQUENCE_DIMENSIONS = 4 };

/* Points of a sequence. Behind the last the first comes again. */
enum { SEQUENCE_POINTS = 1 << 16 };

struct sequence {
    uint32_t scramble[1 + SEQUENCE_DIMENSIONS], odd[1 + SEQUENCE_DIMENSIONS];
};

struct sequence sequence_start(uint64_t seed);

/* The point of this index, each coordinate in 0 <= u < 1. */
void sequence_point(const struct sequence *sequence, uint32_t index,
                    double u[SEQUENCE_DIMENSIONS]);

/* The image of (u, v) in [0, 1) on the triangle; the map keeps ratios of areas. */
static inline struct vec3 triangle_of_square(const struct triangle *t, double u, double v)
{
    double root = sqrt(u), c = root * v, b = root - c;
    return vec3_add(vec3_scale(t->corner[0], 1.0 - root),
                    vec3_add(vec3_scale(t->corner[1], b), vec3_scale(t->corner[2], c)));
}

/* The image of (u, v) in [0, 1) as a direction, distributed as the cosine to `normal`.
 * `along` is at right angles to `normal`; both are of length 1. */
struct vec3 cosine_direction(struct vec3 normal, struct vec3 along, double u, double v);

/* A direction of length 1 at right angles to one of length 1. */
struct vec3 direction_along(struct vec3 normal);

#endif
