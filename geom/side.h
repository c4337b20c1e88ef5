/* Sides of triangles between the same two points: where one triangle goes on in another.
 *
 * Side 3 t + k of triangle t leads from its corner k to the next. */
#ifndef GEOM_SIDE_H
#define GEOM_SIDE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/triangle.h"

static inline struct vec3 side_start(const struct triangle *triangles, int32_t side)
{
    return triangles[side / 3].corner[side % 3];
}

static inline struct vec3 side_end(const struct triangle *triangles, int32_t side)
{
    return triangles[side / 3].corner[(side + 1) % 3];
}

/* Returns same[side], [3 count]: the next side by number with the same two ends, or -1.
 * So sides with the same ends are a list that begins with the lowest. Coordinates are
 * compared to the bit, but for the sign of zeros. Free with alloc_free(). After a signal
 * (geom/stop.h) sides may be alone. */
int32_t *sides_match(const struct triangle *triangles, int32_t count);

#endif
