/* What is seen of a patch from a point past triangles that are known to hide parts of it:
 * its remainder. */
#ifndef RAD_BEYOND_REMAINDER_H
#define RAD_BEYOND_REMAINDER_H

#include "geom/outlook.h"
#include "rad/patch.h"

enum { BLOCKERS_MOST = 24 };

struct remainder {
    int32_t root; /* of the patch */
    struct triangle triangle;
    struct plane plane;
    int32_t blockers[BLOCKERS_MOST]; /* [count] triangles in front of the plane */
    int count;
    struct outlook outlook;
    struct vec3 normal; /* of the surface that it is looked at from */
    int hidden;    /* blockers that have been cut out of the outlook; -1: there is none */
    double whole;  /* factor of the patch without blockers, 1 */
    double before[OUTLOOK_PIECES + 1]; /* factors of the pieces before each, added up,
                                          1 */
};

/* All of the patch. */
struct remainder remainder_start(const struct forest *forest, int32_t patch);

/* True if the triangle is a blocker that was not known and is now. */
bool remainder_learn(struct remainder *remainder, const struct scene *scene,
                     int32_t blocker);

/* Looks from the point x of a surface with this normal. Returns the factor of all that is
 * seen, 1. */
double remainder_look(struct remainder *remainder, const struct scene *scene,
                      struct vec3 x, struct vec3 normal);

/* A point of it as looked at last, chosen by u and v in [0, 1): by the factors of its
 * parts, which are quartered so often at most, less often where they are far for their
 * size, and evenly within these. `density`: at which it was chosen, for each square scene
 * unit; NULL: not wanted. */
struct vec3 remainder_point(const struct remainder *remainder, int quarterings, double u,
                            double v, double *density);

#endif
