/* The exchange of two triangles past a few others, exact from points. */
#ifndef TOOLS_VIEWFACTORS_SCREENED_H
#define TOOLS_VIEWFACTORS_SCREENED_H

#include "rad/formfactor.h"

enum { SCREENS_MAX = 24 };

struct screened {
    double exchange; /* G with visibility, square units of the coordinates */
    double error;    /* of the exchange, at most, as told by points */
    bool agreed;     /* all points see all of the target, or nothing */
};

/* Sets the exchange of p and q with the triangles blockers[0 .. count - 1] in the way;
 * `open` is the exchange without blockers. `tolerance` is the error at which parts of a
 * triangle are no longer divided. Pre: facets_face(p, q), count <= SCREENS_MAX. False if
 * a point sees too many parts of a triangle. */
bool screened_exchange(const struct facet *viewer, const struct facet *target,
                       const struct triangle *triangles, const int32_t *blockers,
                       int32_t count, double open, double tolerance,
                       struct screened *result);

#endif
