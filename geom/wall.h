/* Walls: triangles in one plane, facing the same way, joined by whole sides. Blocking by
 * a wall is proved for whole convex sets, such as triangles or boxes around many. */
#ifndef GEOM_WALL_H
#define GEOM_WALL_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/triangle.h"

/* Borrows all arrays. */
struct walls {
    const struct triangle *triangles; /* in scene units */
    const struct plane *planes;       /* a zero normal: dropped, part of no wall */
    const int32_t *neighbours;        /* of all triangles, three each */
};

/* [3 count] at 3 t + k the triangle with which the wall of triangle t goes on beyond the
 * side from corner k to the next, or -1. Free with alloc_free(). */
int32_t *walls_find_neighbours(const struct triangle *triangles,
                               const struct plane *planes, int32_t count);

/* True if the wall around a triangle is proved to block all segments between two convex
 * sets, given by their corners, but for segments from or to its plane (as where a set has
 * an edge in common with the wall). Finds all proofs if one wall is flat and convex, and
 * no more than some thousand of its triangles are needed. */
bool walls_stand_between(const struct walls *walls, int32_t triangle,
                         const struct vec3 *p, int count_p, const struct vec3 *q,
                         int count_q);

#endif
