/* Points on triangles and directions above them, evenly distributed over seeds. */
#ifndef RAD_SAMPLE_H
#define RAD_SAMPLE_H

#include <stdint.h>

#include "geom/triangle.h"

/* A ray that begins just above a surface. */
struct ray {
    struct vec3 origin, direction; /* of length 1 */
};

/* A point on the triangle. Uses seed and seed + 1. */
struct vec3 triangle_sample(const struct triangle *t, uint64_t seed);

/* A ray from a point of the triangle's front, distributed as the cosine to its unit
 * normal; `ring` of `rings` rings that are equally probable, from the normal outwards.
 * Uses seed to seed + 4. */
struct ray ray_sample(const struct triangle *t, struct vec3 normal, uint64_t seed,
                      int ring, int rings);

#endif
