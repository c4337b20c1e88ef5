/* View factors between the groups of a scene, with blockers.
 *
 * F_ij (1) is the fraction of the light leaving the fronts of group i evenly that arrives
 * first on the fronts of group j. Exchange areas are stored, G_ij = A_i F_ij = A_j F_ji:
 * one number for both directions, so reciprocity is exact; each is a sum of integers
 * (rad/flux.h), independent of ranks and order. */
#ifndef TOOLS_VIEWFACTORS_VIEWFACTOR_H
#define TOOLS_VIEWFACTORS_VIEWFACTOR_H

#include <stdint.h>

#include "octree/octree.h"
#include "rad/beyond/patch_exchange.h"

enum { VIEWFACTOR_GROUPS_MAX = 8192 }; /* half a matrix: half a GiB, and more */

struct viewfactors {
    const struct scene *scene;   /* borrowed */
    const struct octree *octree; /* borrowed */
    double epsilon;              /* see viewfactors_add() */
    int max_level;               /* deepest subdivision, 0..ID_MAX_LEVEL */
    int32_t count;               /* groups */
    double *areas;               /* [count] of the roots, square scene units */
    int32_t *roots;              /* [count] number of roots with an area */
    int64_t *sums;               /* [pairs] G_ij of i <= j, row by row, each in a unit */
    int64_t *errors;             /* [pairs] variances of G_ij, each in a unit */
    bool *done;                  /* [pairs] G_ij is good enough: nothing is added */
    int64_t pairs;               /* count (count + 1) / 2 */
    int64_t links;               /* parts added so far */
    int32_t away;                /* roots that face no other */
    int32_t first_away;          /* the first of them */
    struct octree_counts counts; /* work so far */
};

/* Sets all exchanges to 0. Pre: the scene is prepared and has at most
 * VIEWFACTOR_GROUPS_MAX groups. */
struct viewfactors *viewfactors_create(const struct scene *scene,
                                       const struct octree *octree, double epsilon,
                                       int max_level);
void viewfactors_destroy(struct viewfactors *factors);

/* Adds the exchange of the roots p < q to their groups' exchange. The result is exact
 * where visibility is proved, and all but exact past few triangles. Elsewhere pairs are
 * refined until the exchange of two patches in doubt is at most epsilon times the area of
 * the smaller group, or max_level is reached.
 * Pre: facets_face(fp, fq). */
void viewfactors_add(struct viewfactors *factors, int32_t p, const struct facet *fp,
                     int32_t q, const struct facet *fq);

/* Sets the exchange of two groups, square scene units, and its variance, in place of what
 * was added. Pre: both have an area. */
void viewfactors_set(struct viewfactors *factors, int32_t i, int32_t j, double exchange,
                     double variance);

/* Returns F_ij by the pairs added so far; 0 for a group without area. */
double viewfactors_factor(const struct viewfactors *factors, int32_t i, int32_t j);

/* Returns the sum of the row of a group, by the pairs added so far. */
double viewfactors_row(const struct viewfactors *factors, int32_t i);

/* Returns the largest error of all F, as far as the pairs added so far tell; 0 if all are
 * exact. */
double viewfactors_error(const struct viewfactors *factors);

/* Makes epsilon smaller and takes back all pairs of groups whose error makes the error of
 * all F larger than `accuracy`, to be added again; the other pairs are done, and adding
 * to these does nothing. Pre: viewfactors_error() > accuracy > 0. */
void viewfactors_refine(struct viewfactors *factors, double accuracy);

#endif
