/* Steps 5 and 6 for both solvers: the transfer of light over the links there are, and what is made
 * of it at home. Jacobi, the paper's: B = E + rho H, and the next refinement. Conjugate gradients:
 * one step (rad/beyond/conjugate.c), until the bound on what is still missing is small enough. */
#include "mpi/beyond/beyond.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

/* --- the transfer of light --- */

/* At most; the same on all ranks. When links have changed all ranks know all radiosities. */
static double largest_radiosity(const struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    double largest = fmax(solver->beyond->descent.fresh ? 0.0 : solver->ballot.brightest, 1e-250);
    for (int64_t p = 0; p < forest->count && solver->beyond->descent.fresh; p++)
        for (int c = 0; c < BANDS; c++) {
            double size = fabs(forest->patches[p].radiosity.band[c]);
            largest = size > largest ? size : largest;
        }
    return largest;
}

/* Own patches keep their flux from the gather on; all others have given theirs away. */
static void clear_own_flux(struct solver *solver)
{
    const struct routes *routes = &solver->routes;
    const int32_t *own = routes->receivers + routes->receiver_at[solver->comm->rank];
    for (int i = 0; i < routes->receiver_counts[solver->comm->rank]; i++)
        for (int c = 0; c < BANDS; c++)
            solver->model.forest->patches[own[i]].flux[c] = 0;
}

void solver_transfer(struct solver *solver)
{
    double start = comm_seconds();
    struct forest *forest = solver->model.forest;
    clear_own_flux(solver);
    double room = solver->beyond->tree ? 2.0 : 1.0; /* a node receives over links of its cluster, too */
    solver->flux = flux_unit_for(room * largest_radiosity(solver) * solver->model.area);
    if (solver->beyond->tree) {
        cluster_light_pull(solver->model.clusters, forest);
        memset(solver->model.clusters->flux, 0,
               BANDS * (size_t)solver->beyond->tree->count * sizeof *solver->model.clusters->flux);
    }
    double begun = comm_seconds();
    solver->model.method.transfer(&solver->links, &solver->model, solver->flux);
    double done = comm_seconds();
    solver->account.seconds[PHASE_SOLVE] += done - begun;
    solver->account.seconds[PHASE_SUMS] += comm_seconds() - done + begun - start;
}

/* --- conjugate gradients --- */

static void start_conjugate(struct solver *solver)
{
    struct conjugate *cg = &solver->beyond->descent.vectors;
    conjugate_start(cg, &solver->model, &solver->beyond->closure, solver->flux);
    struct flux_unit any = flux_unit_for(1.0);
    double own = conjugate_sum(cg, &solver->model, &solver->beyond->closure, any).largest;
    solver->beyond->descent.bound_residual = comm_largest(solver->comm, own);
    solver->beyond->descent.bound_image = 0.0;
    for (int c = 0; c < BANDS; c++)
        solver->beyond->descent.step_before[c] = 0.0;
}

/* <K z, z> over all ranks, W^2 m^-2. */
static void multiply(struct solver *solver, double bound, double product[BANDS])
{
    struct flux_unit unit = conjugate_unit(&solver->model, bound, solver->beyond->descent.bound_residual,
                                           solver->beyond->descent.weight);
    int64_t own[BANDS] = {0, 0, 0}, all[BANDS];
    conjugate_apply(&solver->beyond->descent.vectors, &solver->model, &solver->beyond->closure,
                    solver->flux, unit, own);
    MPI_Request request;
    MPI_Iallreduce(own, all, BANDS, MPI_INT64_T, MPI_SUM, solver->comm->handle, &request);
    comm_wait(&request);
    for (int c = 0; c < BANDS; c++)
        product[c] = flux_to_watts(unit, all[c]);
}

static void step_conjugate(struct solver *solver)
{
    double image = solver->beyond->descent.bound_residual * (1.0 + solver->beyond->descent.gain);
    double delta[BANDS], turn[BANDS] = {0.0}, step[BANDS] = {0.0};
    double longest_turn = 0.0, longest_step = 0.0;
    multiply(solver, image, delta);
    for (int c = 0; c < BANDS; c++) {
        double gamma = solver->beyond->descent.gamma[c], before = solver->beyond->descent.step_before[c];
        if (!(gamma > 0.0))
            continue;
        turn[c] = before > 0.0 ? gamma / solver->beyond->descent.gamma_before[c] : 0.0;
        double bend = delta[c] - (before > 0.0 ? turn[c] * gamma / before : 0.0);
        if (!(bend > 0.0) && solver->beyond->descent.shrink < 1.0) { /* rounding, since K is positive: start afresh */
            turn[c] = 0.0;
            bend = delta[c];
        }
        solver->beyond->descent.diverged = solver->beyond->descent.diverged || !(bend > 0.0);
        step[c] = bend > 0.0 ? gamma / bend : 0.0;
        solver->beyond->descent.least_bend = fmin(solver->beyond->descent.least_bend, delta[c] / gamma);
        longest_turn = fmax(longest_turn, turn[c]);
        longest_step = fmax(longest_step, step[c]);
        solver->beyond->descent.gamma_before[c] = gamma;
        solver->beyond->descent.step_before[c] = step[c];
    }
    conjugate_advance(&solver->beyond->descent.vectors, &solver->model, turn, step);
    solver->beyond->descent.bound_image = image + longest_turn * solver->beyond->descent.bound_image;
    solver->beyond->descent.bound_residual += longest_step * solver->beyond->descent.bound_image;
}

static void push_pull_conjugate(struct solver *solver)
{
    if (solver->beyond->descent.fresh)
        start_conjugate(solver);
    else
        step_conjugate(solver);
    solver->beyond->descent.fresh = false;
    conjugate_publish(&solver->beyond->descent.vectors, &solver->model, false);
}

void solver_push_pull(struct solver *solver)
{
    double start = comm_seconds();
    solver->turn.iteration++;
    if (solver->model.criterion.solver == SOLVER_CG)
        push_pull_conjugate(solver);
    else
        solver->change.sums = push_pull(&solver->model, &solver->beyond->closure, solver->flux, solver->homes.own,
                                 solver->change.of_root);
    solver_cast_ballot(solver);
    solver->account.seconds[PHASE_PUSH_PULL] += comm_seconds() - start;
}
