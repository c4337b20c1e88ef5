/* The part of a triangle visible from a point past other triangles, exactly. */
#ifndef TOOLS_VIEWFACTORS_OUTLOOK_H
#define TOOLS_VIEWFACTORS_OUTLOOK_H

#include <stdbool.h>

#include "geom/triangle.h"

enum { OUTLOOK_PIECES = 24, OUTLOOK_CORNERS = 12 };

/* A convex polygon. */
struct outlook_piece {
    struct vec3 corner[OUTLOOK_CORNERS]; /* [count] */
    int count;
};

/* Pieces side by side. */
struct outlook {
    struct vec3 from;
    struct outlook_piece piece[OUTLOOK_PIECES]; /* [count] */
    int count;
};

/* All of the triangle is seen. */
void outlook_start(struct outlook *outlook, struct vec3 from, const struct triangle *t);

/* Takes away the part hidden behind another triangle, which has to lie in front of the
 * first one's plane, as the point does. Leaves a piece whole where pieces or corners
 * would be too many, and returns false then. */
bool outlook_hide(struct outlook *outlook, const struct triangle *behind);

#endif
