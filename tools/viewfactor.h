/* View factors between the groups of a scene, with blockers: what phr --form-factors prints.
 *
 * F_ij (1) is the share of the light that leaves the fronts of group i evenly and arrives on the
 * fronts of group j before anything else. What is kept is the exchange area G_ij = A_i F_ij =
 * A_j F_ji, one number for both directions, so reciprocity is exact; it is a sum of integers
 * (rad/flux.h), so it does not depend on who adds which part, nor in which order. */
#ifndef TOOLS_VIEWFACTOR_H
#define TOOLS_VIEWFACTOR_H

#include <stdbool.h>
#include <stdint.h>

#include "octree/octree.h"
#include "rad/beyond/patch_exchange.h"

enum { VIEWFACTOR_GROUPS_MAX = 8192 }; /* above: half a matrix is more than a quarter of a GiB */

struct viewfactors {
    const struct scene *scene;   /* borrowed, like the octree */
    const struct octree *octree;
    double epsilon;              /* see viewfactors_add() */
    int max_level;               /* deepest subdivision, 0..ID_MAX_LEVEL */
    int32_t count;               /* groups */
    double *areas;               /* [count] of the roots, square scene units */
    int32_t *roots;              /* [count] number of roots with an area */
    int64_t *sums;               /* [pairs] G_ij of i <= j row by row, each in a unit of its own */
    int64_t pairs;               /* count (count + 1) / 2 */
    int64_t links;               /* parts added so far */
    struct octree_counts counts; /* work so far */
};

/* All exchanges 0. Pre: the scene is prepared and has at most VIEWFACTOR_GROUPS_MAX groups. */
struct viewfactors *viewfactors_create(const struct scene *scene, const struct octree *octree,
                                       double epsilon, int max_level);
void viewfactors_destroy(struct viewfactors *factors);

/* Adds the exchange of the roots p < q to that of their groups. It is exact where visibility is
 * proved. Elsewhere it is refined until what is in doubt between two patches is at most epsilon of
 * the smaller of the areas of the two groups, or max_level is reached. Pre: facets_face(fp, fq). */
void viewfactors_add(struct viewfactors *factors, int32_t p, const struct facet *fp, int32_t q,
                     const struct facet *fq);

/* G_ij of what has been added, square scene units. */
double viewfactors_exchange(const struct viewfactors *factors, int32_t i, int32_t j);

/* F_ij of what has been added; 0 for a group without area. */
double viewfactors_factor(const struct viewfactors *factors, int32_t i, int32_t j);

#endif
