/* Steps 5 and 6 for both solvers: the transfer of light over the links there are, and what is made
 * of it at home. Jacobi, the paper's: B = E + rho H, and the next refinement. Conjugate gradients:
 * one step (rad/beyond/conjugate.c), until the bound on what is still missing is small enough. */
#include "mpi/solver.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

/* --- the transfer of light --- */

/* At most; the same on all ranks. When links have changed all ranks know all radiosities. */
static double largest_radiosity(const struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    double largest = fmax(solver->fresh ? 0.0 : solver->ballot.brightest, 1e-250);
    for (int64_t p = 0; p < forest->count && solver->fresh; p++)
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

/* What leaves send with --closure symmetric. */
static void correct_senders(struct forest *forest, const struct closure *closure)
{
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS && patch_is_leaf(&forest->patches[p]); c++)
            forest->patches[p].radiosity.band[c] *= closure_sends(closure, (int32_t)p);
    forest_average(forest);
}

void solver_transfer(struct solver *solver)
{
    double start = comm_seconds();
    struct forest *forest = solver->model.forest;
    bool corrects = solver->closure.kind == CLOSURE_SYMMETRIC;
    struct rgb *kept = corrects ? forest_keep(forest) : NULL;
    if (corrects)
        correct_senders(forest, &solver->closure);
    clear_own_flux(solver);
    double room = solver->tree ? 2.0 : 1.0; /* a node receives over links of its cluster, too */
    solver->flux = flux_unit_for(room * largest_radiosity(solver) * solver->model.area);
    if (solver->tree) {
        cluster_light_pull(solver->model.clusters, forest);
        memset(solver->model.clusters->flux, 0,
               BANDS * (size_t)solver->tree->count * sizeof *solver->model.clusters->flux);
    }
    double begun = comm_seconds();
    if (solver->tree)
        node_links_transfer(&solver->links, &solver->model, solver->flux);
    else
        links_transfer(&solver->links, forest, solver->flux);
    double done = comm_seconds();
    if (corrects)
        forest_restore(forest, kept);
    solver->seconds[PHASE_SOLVE] += done - begun;
    solver->seconds[PHASE_SUMS] += comm_seconds() - done + begun - start;
}

/* --- conjugate gradients --- */

static void start_conjugate(struct solver *solver)
{
    struct conjugate *cg = &solver->conjugate;
    conjugate_start(cg, &solver->model, &solver->closure, solver->flux);
    struct flux_unit any = flux_unit_for(1.0);
    double own = conjugate_sum(cg, &solver->model, &solver->closure, any).largest;
    solver->bound_residual = comm_largest(solver->comm, own);
    solver->bound_image = 0.0;
    for (int c = 0; c < BANDS; c++)
        solver->step_before[c] = 0.0;
}

/* <K z, z> over all ranks, W^2 m^-2. */
static void multiply(struct solver *solver, double bound, double product[BANDS])
{
    struct flux_unit unit = conjugate_unit(&solver->model, bound, solver->bound_residual,
                                           solver->weight);
    int64_t own[BANDS] = {0, 0, 0}, all[BANDS];
    conjugate_apply(&solver->conjugate, &solver->model, &solver->closure,
                    solver->flux, unit, own);
    MPI_Request request;
    MPI_Iallreduce(own, all, BANDS, MPI_INT64_T, MPI_SUM, solver->comm->handle, &request);
    comm_wait(&request);
    for (int c = 0; c < BANDS; c++)
        product[c] = flux_to_watts(unit, all[c]);
}

static void step_conjugate(struct solver *solver)
{
    double image = solver->bound_residual * (1.0 + solver->gain);
    double delta[BANDS], turn[BANDS] = {0.0}, step[BANDS] = {0.0};
    double longest_turn = 0.0, longest_step = 0.0;
    multiply(solver, image, delta);
    for (int c = 0; c < BANDS; c++) {
        double gamma = solver->gamma[c], before = solver->step_before[c];
        if (!(gamma > 0.0))
            continue;
        turn[c] = before > 0.0 ? gamma / solver->gamma_before[c] : 0.0;
        double bend = delta[c] - (before > 0.0 ? turn[c] * gamma / before : 0.0);
        if (!(bend > 0.0) && solver->shrink < 1.0) { /* rounding, since K is positive: start afresh */
            turn[c] = 0.0;
            bend = delta[c];
        }
        solver->diverged = solver->diverged || !(bend > 0.0);
        step[c] = bend > 0.0 ? gamma / bend : 0.0;
        solver->least_bend = fmin(solver->least_bend, delta[c] / gamma);
        longest_turn = fmax(longest_turn, turn[c]);
        longest_step = fmax(longest_step, step[c]);
        solver->gamma_before[c] = gamma;
        solver->step_before[c] = step[c];
    }
    conjugate_advance(&solver->conjugate, &solver->model, turn, step);
    solver->bound_image = image + longest_turn * solver->bound_image;
    solver->bound_residual += longest_step * solver->bound_image;
}

static void push_pull_conjugate(struct solver *solver)
{
    if (solver->fresh)
        start_conjugate(solver);
    else
        step_conjugate(solver);
    solver->fresh = false;
    conjugate_publish(&solver->conjugate, &solver->model, false);
}

void solver_push_pull(struct solver *solver)
{
    double start = comm_seconds();
    solver->iteration++;
    if (solver->model.criterion.solver == SOLVER_CG)
        push_pull_conjugate(solver);
    else
        solver->sums = push_pull(&solver->model, &solver->closure, solver->flux, solver->own,
                                 solver->root_change);
    solver_cast_ballot(solver);
    solver->seconds[PHASE_PUSH_PULL] += comm_seconds() - start;
}
