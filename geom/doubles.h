/* Faces lying exactly on each other: which repeat an earlier one, which stand back to
 * back with another. */
#ifndef GEOM_DOUBLES_H
#define GEOM_DOUBLES_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/triangle.h"

/* A scene's triangles, in the order of the file; borrowed. */
struct faces {
    const struct triangle *triangles; /* [count] */
    const double *areas;              /* [count]; 0: degenerate, never kept */
    const bool *goes_on;              /* [count]: cut from the same face of the file as
                                       * the triangle before; NULL: none */
    int32_t count;
};

/* The number of the triangle behind the last of the face of triangle i. */
int32_t face_end(const struct faces *faces, int32_t i);

/* Sets first[i] to the number of an earlier triangle if triangle i, or its face, has the
 * corners of an earlier kept one, in any rotation, and faces the same way; else to i: the
 * triangle is kept. For a face of several triangles, the number is that of the earlier
 * face's first.
 * Sets opposite[i], for a kept i, to the number of the kept triangle with the corners of
 * i facing the other way; else to -1. Of faces of several triangles, all are paired in
 * order, whatever their corners: the faces are alike, the diagonals may not be.
 * Both arrays: [count]. Corners are the same if their coordinates are equal. Takes time
 * and memory in proportion to the number of triangles. */
void doubles_find(const struct faces *faces, int32_t *first, int32_t *opposite);

#endif
