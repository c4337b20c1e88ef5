/* Steps 5 and 8 with conjugate residuals (rad/beyond/conjugate.c): iterations go on over
 * the same links until the bound on the remaining error is small enough. */
#include "mpi/beyond/descent.h"

#include <math.h>

#include "geom/alloc.h"
#include "mpi/beyond/beyond.h"

/* A solution has diverged if its negative light is more than the remaining error can make
 * and 1 / NEGATIVE of all light: with row sums too large for a solution, the equation may
 * still have one with negative light. */
enum { NEGATIVE = 100 };

/* The tolerance while links are still being split, in parts of the reflected light (not
 * of all light: lamps may emit nearly all of theirs into the void). Of the iterations at
 * 1 %, 3 % saves a tenth, and a corridor getting dimmer and dimmer has 0.2 % fewer
 * patches; at 6 % 0.4 % fewer. */
static const double WHILE_SPLITTING = 0.03;

static void largest_of_all(void *context, double *numbers, int64_t count)
{
    const struct solver *solver = context;
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, numbers, comm_count(solver->comm, count), MPI_DOUBLE,
                   MPI_MAX, solver->comm->handle, &request);
    comm_wait(&request);
}

static void add_of_all(void *context, int64_t *numbers, int64_t count)
{
    const struct solver *solver = context;
    comm_add(solver->comm, numbers, count);
}

struct totals totals_of(struct solver *solver, int64_t terms)
{
    return (struct totals){largest_of_all, add_of_all, solver, terms};
}

/* Measures row sums as the irradiances of B = 1. */
void descent_begin(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    solver_carry_ones(solver);
    conjugate_begin(solver->beyond->descent, forest, solver->homes.own, solver->flux,
                    totals_of(solver, forest->count));
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

/* Collective. The light below 0 of all leaves, W. */
static double negative_light(const struct conjugate *cg, const struct forest *forest)
{
    double sum;
    for (int64_t i = 0; i < cg->count; i++) {
        cg->terms[i] = 0.0;
        for (int c = 0; c < BANDS; c++)
            cg->terms[i] += forest_area(forest, cg->leaves[i]) *
                            fmax(0.0, -forest->radiosity[cg->leaves[i]].band[c]);
    }
    total_up(&cg->totals, cg->terms, cg->count, 1, &sum);
    return sum;
}

/* Collective. The light for the next iteration, and step 7 of this one. */
static void step(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    conjugate_step(solver->beyond->descent, forest);
    patches_average(forest, solver->homes.patches, solver->homes.count);
    solver->beyond->scatter(solver);
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
        step(solver);
    else if (negative_light(cg, forest) > (remaining + 1.0 / NEGATIVE) * light)
        vote.diverged = true;
    return vote;
}
