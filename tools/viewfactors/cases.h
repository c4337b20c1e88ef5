/* Cases with exact answers, for viewfactors --validate. */
#ifndef TOOLS_VIEWFACTORS_CASES_H
#define TOOLS_VIEWFACTORS_CASES_H

#include <stdint.h>

#include "geom/vec.h"

enum { CASE_CORNERS = 4 };

/* Two polygons and the form factor from the first to the second. */
struct pair_case {
    const char *id, *text;
    double factor; /* 1; exact in all digits */
    int32_t count[2];
    struct vec3 corner[2][CASE_CORNERS]; /* counter-clockwise seen from the front */
};

extern const struct pair_case PAIR_CASES[];
extern const int PAIR_CASE_COUNT;

/* Illuminances of CIE 171:2006, 5.3: at a point of a room of 4 x 4 x 3 m, by a light of 1
 * x 1 m and 1000 cd/m^2 in the middle of its ceiling. */
struct point_case {
    const char *text;
    struct vec3 x;         /* m */
    struct vec3 normal;    /* 1 */
    double exact;          /* lx */
    double printed;        /* lx, as the report rounds it */
};

extern const struct point_case POINT_CASES[];
extern const int POINT_CASE_COUNT;

/* The light of the point cases. */
extern const struct vec3 CIE_LIGHT[4];

#endif
