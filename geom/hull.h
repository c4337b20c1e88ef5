/* The space between two triangles: the place of everything that can stand between. */
#ifndef GEOM_HULL_H
#define GEOM_HULL_H

#include "geom/triangle.h"

/* Half spaces whose intersection is the convex hull of two triangles, as far as the hull
 * lies in front of both: the points behind all planes. */
struct hull {
    struct plane planes[2 + 18];
    int count;
};

/* Pre: each has a corner in front of the other. */
struct hull hull_of_pair(const struct triangle *p, const struct plane *plane_p,
                         const struct triangle *q, const struct plane *plane_q);

/* True if the triangle reaches into the hull by more than rounding. If none of a scene
 * does, no segment from the front of p to the front of q is blocked: such segments lie in
 * the hull. */
bool hull_is_entered(const struct hull *hull, const struct triangle *t);

#endif
