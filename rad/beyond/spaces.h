/* Spaces: parts of a scene that no ray connects, as two closed rooms.
 *
 * A small error of a bright room is all the light of a dim one. So errors, noise and the
 * light that makes a lamp a lamp are relative to the light of one space.
 *
 * A space with a lamp has a number. One without has the number of the brightest: its
 * light, if there is any, comes from elsewhere. */
#ifndef RAD_BEYOND_SPACES_H
#define RAD_BEYOND_SPACES_H

#include <stdint.h>

#include "geom/scene.h"
#include "octree/octree.h"

struct spaces {
    int32_t *part;  /* [roots + 1] a number, 0 .. roots, of each root and, last, of the
                       outside: the same where rays connect */
    int32_t *of;    /* [roots] the number of a root's space */
    double *light;  /* [count] of all light the part in a space, 1; space 0 has most */
    double *area;   /* [count] of the surfaces of a space but a sky and, if there are
                       several spaces, parts without a lamp, square scene units */
    int32_t count;  /* at least 1 */
};

/* Returns the number of rays from each root that tell its space: 4, or more where there
 * are few roots, so that a door ajar is found. */
int space_rays(const struct scene *scene);

/* [space_rays() for each of the roots first .. end - 1] where its rays end: a root, the
 * number of all roots for the outside, or -1 (on a back, or the root has no area). To be
 * freed with alloc_free(). */
int32_t *places_met(const struct scene *scene, const struct octree *octree,
                    int32_t first, int32_t end);

/* The spaces by the places met by all roots; NULL: all roots are in one. */
struct spaces *spaces_create(const struct scene *scene, const int32_t *met);
void spaces_destroy(struct spaces *spaces); /* NULL: none */

/* How many times the light of a root's space there is in the brightest, 1 or more.
 * `spaces`: NULL for one. */
static inline double space_dimness(const struct spaces *spaces, uint32_t root)
{
    return spaces ? spaces->light[0] / spaces->light[spaces->of[root]] : 1.0;
}

/* The light of the scene, W in square scene units: the power of lamps (of a sky what
 * enters); or, if more, a tenth of all light when spread evenly. */
double scene_light(const struct scene *scene);

#endif
