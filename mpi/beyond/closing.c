/* Between refinement and transfer: the row sums of the links there are, and the closure.
 *
 * B = 1 is transferred like light; what arrives per area is a leaf's row sum R, at most 1 in truth.
 * --closure cap: where links make it so large that light would grow, or all but grow, from bounce to
 * bounce, the leaf receives less; then there is always a solution, and the bound on the iteration
 * error always holds.
 * --closure rows: the same, and an enclosed leaf receives 1 / R of what its links bring, so
 * that its row sums to 1. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "geom/alloc.h"

/* Transfers B = 1 and brings it home. */
static void transfer_ones(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    for (int64_t p = 0; p < forest->count; p++)
        forest->patches[p].radiosity = (struct rgb){{1.0, 0.0, 0.0}};
    solver_transfer(solver);
    solver_gather(solver);
}

/* Row sum times reflectance is what light grows by from bounce to bounce; it is kept below this, or
 * half way from rho to 1 where that is more. Less took light from leaves close to lamps, whose rows
 * are made of links of many levels; at 0.95 the errors are those of no cap. */
static const double MOST_REFLECTED = 0.95;

static double largest_row(const struct solver *solver, int32_t leaf)
{
    struct rgb rho = forest_material(solver->model.forest, leaf)->reflectance;
    double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2]));
    return largest > 0.0 ? fmax(MOST_REFLECTED, 0.5 * (1.0 + largest)) / largest : HUGE_VAL;
}

/* Finds the factors of own leaves anew. */
static void renew_factors(struct solver *solver)
{
    struct closure *closure = &solver->beyond->closure;
    for (int64_t i = 0; i < solver->beyond->descent.vectors.leaf_count; i++) {
        int32_t p = solver->beyond->descent.vectors.leaves[i];
        double row = leaf_irradiance(solver->model.forest, p, solver->flux).band[0];
        bool due = row > 0.0 && closure->kind == CLOSURE_ROWS &&
                   closure_is_due(closure, &solver->model, p);
        closure->factor[p] = due ? 1.0 / row : fmin(1.0, largest_row(solver, p) / row);
    }
}

/* Over all leaves of all ranks: the largest corrected row sum; that times the largest reflectance of the leaf;
 * weight; and reflectance over weight. */
static void bound_rows(struct solver *solver)
{
    const struct model *model = &solver->model;
    double bound[4] = {1.0, 0.0, 1.0, 0.0}; /* gain, shrink, weight, share */
    for (int64_t i = 0; i < solver->beyond->descent.vectors.leaf_count; i++) {
        int32_t leaf = solver->beyond->descent.vectors.leaves[i];
        double row = closure_receives(&solver->beyond->closure, leaf) *
                     leaf_irradiance(model->forest, leaf, solver->flux).band[0];
        struct rgb rho = forest_material(model->forest, leaf)->reflectance;
        double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2]));
        double weight = closure_weight(&solver->beyond->closure, leaf);
        bound[0] = fmax(bound[0], row);
        bound[1] = fmax(bound[1], row * largest);
        bound[2] = fmax(bound[2], weight);
        bound[3] = fmax(bound[3], largest / weight);
    }
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, bound, 4, MPI_DOUBLE, MPI_MAX, solver->comm->handle, &request);
    comm_wait(&request);
    solver->beyond->descent.gain = bound[0];
    solver->beyond->descent.shrink = bound[1];
    solver->beyond->descent.weight = bound[2];
    solver->beyond->descent.share = bound[3];
}

void solver_close(struct solver *solver)
{
    const struct criterion *criterion = &solver->model.criterion;
    struct forest *forest = solver->model.forest;
    double start = comm_seconds();
    routes_renew(solver);
    closure_extend(&solver->beyond->closure, forest);
    conjugate_extend(&solver->beyond->descent.vectors, forest, solver->homes.own);
    solver->account.seconds[PHASE_ROUTES] += comm_seconds() - start;
    if (criterion->closure == CLOSURE_NONE && criterion->solver == SOLVER_JACOBI)
        return;
    struct rgb *kept = forest_keep(forest);
    transfer_ones(solver);
    if (criterion->closure != CLOSURE_NONE)
        renew_factors(solver);
    bound_rows(solver);
    forest_restore(forest, kept);
}
