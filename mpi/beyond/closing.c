/* Before light is transferred over new links: their row sums, and the caps on them
 * (rad/beyond/closure.h). B = 1 is transferred like light. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "geom/alloc.h"

/* Transfers B = 1, and brings it home. */
static void transfer_ones(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    for (int64_t p = 0; p < forest->count; p++)
        forest->patches[p].radiosity = (struct rgb){{1.0, 0.0, 0.0}};
    solver_carry(solver);
}

static void cap_rows(struct solver *solver)
{
    const struct conjugate *vectors = &solver->beyond->descent.vectors;
    for (int64_t i = 0; i < vectors->leaf_count; i++) {
        int32_t leaf = vectors->leaves[i];
        double row = leaf_irradiance(solver->model.forest, leaf, solver->flux).band[0];
        closure_cap(&solver->beyond->closure, solver->model.forest, leaf, row);
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
        double row = solver->beyond->closure.factor[leaf] *
                     leaf_irradiance(model->forest, leaf, solver->flux).band[0];
        struct rgb rho = forest_material(model->forest, leaf)->reflectance;
        double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2]));
        double weight = 1.0 / solver->beyond->closure.factor[leaf];
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

void closing_begin(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    closure_extend(&solver->beyond->closure, forest);
    conjugate_extend(&solver->beyond->descent.vectors, forest, solver->homes.own);
    solver->beyond->descent.fresh = true;
    struct rgb *kept = forest_keep(forest);
    transfer_ones(solver);
    cap_rows(solver);
    bound_rows(solver);
    forest_restore(forest, kept);
}

void solver_measure_closure(struct solver *solver, struct stats *stats)
{
    const struct comm *comm = solver->comm;
    struct forest *forest = solver->model.forest;
    struct rgb *kept = forest_keep(forest);
    for (int64_t p = 0; p < forest->count; p++)
        forest->patches[p].radiosity = (struct rgb){{1.0, 0.0, 0.0}};
    int64_t bytes = solver->account.bytes_gather, copied = solver->account.copied; /* not of the method */
    double start = comm_seconds(), seconds[PHASE_COUNT];
    memcpy(seconds, solver->account.seconds, sizeof seconds);
    routes_renew(solver); /* a finished run that was resumed has none */
    solver_carry(solver);
    forest_restore(forest, kept);
    solver->account.bytes_gather = bytes;
    solver->account.copied = copied;
    memcpy(solver->account.seconds, seconds, sizeof seconds);
    struct closure_sums own = closure_measure(forest, solver->homes.own, solver->flux);
    struct closure_sums *all = comm_gather_each(comm, &own, sizeof own);
    struct closure_sums sum = {.min = HUGE_VAL, .max = -HUGE_VAL};
    for (int r = 0; r < comm->size; r++) {
        sum.min = fmin(sum.min, all[r].min);
        sum.max = fmax(sum.max, all[r].max);
        sum.area = flux_add(sum.area, all[r].area);
        sum.rows = flux_add(sum.rows, all[r].rows);
        sum.squares = flux_add(sum.squares, all[r].squares);
    }
    alloc_free(all);
    double area = sum.area > 0 ? (double)sum.area : 1.0; /* 0: too small to count, all is 0 */
    stats->closure_min = sum.min;
    stats->closure_max = sum.max;
    stats->closure_mean = (double)sum.rows / area;
    stats->closure_rms = sqrt((double)sum.squares / area);
    solver->account.seconds[PHASE_ROW_SUMS] += comm_seconds() - start;
}

