/* Faces that lie exactly on each other: which repeat an earlier one, which stand back to
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
    const bool *goes_on;              /* [count]: it is cut from the same face of the file
                                       * as the triangle before it; NULL: none is */
    int32_t count;
};

/* The number of the triangle behind the last of the face that triangle i is of. */
int32_t face_end(const struct faces *faces, int32_t i);

/* Sets first[i] to the number of an earlier triangle if triangle i, or the face that it
 * is cut from, has the corners of an earlier one that is kept, in any rotation, and faces
 * the same way; else to i: it is kept. Of a face of several triangles that is the number
 * of the earlier face's first.
 * Sets opposite[i] to the number of the kept triangle that has the corners of i, which is
 * kept, too, and faces the other way; else to -1. Of faces of several triangles, all are
 * paired in order, from which they may differ: the faces are alike, the diagonals may not
 * be.
 * Both arrays: [count]. Corners are the same if their coordinates are equal. Takes time
 * and memory in proportion to the number of triangles. */
void doubles_find(const struct faces *faces, int32_t *first, int32_t *opposite);

#endif
