/* Steps 5 and 8 with conjugate residuals (rad/beyond/conjugate.c): iterations go on over
 * the same links until the bound on the remaining error is small enough. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "geom/alloc.h"

/* A solution has diverged if its negative light is more than the remaining error can make
 * and 1 / NEGATIVE of all light: with row sums too large for a solution, the equation may
 * still have one with negative light. */
enum { NEGATIVE = 100 };

/* The tolerance while links are still being split, in parts of the reflected light (not
 * of all light: lamps may emit nearly all of theirs into the void). Of the iterations at
 * 1 %, 3 % saves a tenth, and a corridor getting dimmer and dimmer has 0.2 % fewer
 * patches; at 6 % 0.4 % fewer. */
static const double WHILE_SPLITTING = 0.03;

/* Measures row sums as the irradiances of B = 1, and tells all ranks. */
void descent_begin(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    const struct routes *routes = &solver->routes;
    struct rgb *rows = alloc_array((size_t)forest->count, sizeof *rows);
    int rank = solver->comm->rank;
    solver_carry_ones(solver);
    for (int i = 0; i < routes_leaves(routes, rank); i++) {
        int32_t leaf = routes->leaves[routes->at[rank] + i];
        rows[leaf] = leaf_irradiance(forest, leaf, solver->flux);
    }
    solver_share(solver, rows);
    conjugate_begin(solver->beyond->descent, forest, rows);
    alloc_free(rows);
}

/* The remaining error, relative to all light, at which iteration over the links ends. */
static double wanted_of(const struct solver *solver, const struct ballot *sum)
{
    double tolerance = solver->model.criterion.tolerance;
    if (sum->split == 0 && sum->divided == 0)
        return tolerance;
    double light = flux_to_watts(solver->model.flux_unit, sum->light);
    double reflected = light - solver->model.emitted_power;
    return reflected > 0.0 ? fmax(tolerance, WHILE_SPLITTING * reflected / light)
                           : tolerance;
}

/* The light below 0 of all leaves, W. */
static double negative_light(const struct forest *forest)
{
    double sum = 0.0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        for (int c = 0; c < BANDS; c++)
            sum += forest_area(forest, leaf) *
                   fmax(0.0, -forest->radiosity[leaf].band[c]);
    return sum;
}

struct vote descent_vote(struct solver *solver, const struct ballot *sum)
{
    const struct criterion *criterion = &solver->model.criterion;
    struct forest *forest = solver->model.forest;
    struct conjugate *cg = solver->beyond->descent;
    double light = flux_to_watts(solver->model.flux_unit, sum->light);
    double missing = conjugate_missing(cg, forest, solver->model.spaces);
    double remaining = sum->light > 0 ? missing / light : 0.0;
    double wanted = wanted_of(solver, sum);
    struct vote vote = vote_make(solver, sum, remaining);
    bool more = !(remaining <= wanted) && !vote.diverged;
    vote.unfinished = more && solver->turn.iteration >= criterion->max_iterations;
    vote.again = more && !vote.unfinished;
    if (vote.again)
        conjugate_step(cg, forest);
    else if (negative_light(forest) > (remaining + 1.0 / NEGATIVE) * light)
        vote.diverged = true;
    return vote;
}
