/* Before light is transferred over new links: their row sums, and the caps on them
 * (rad/beyond/caps.h). B = 1 is transferred like light. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "geom/alloc.h"

/* Transfers 1 from all patches. */
static void carry_ones(struct solver *solver)
{
    size_t count = (size_t)solver->model.forest->count;
    struct rgb *ones = alloc_array(count, sizeof *ones);
    for (size_t p = 0; p < count; p++)
        ones[p] = (struct rgb){{1.0, 0.0, 0.0}};
    solver_carry(solver, ones);
    alloc_free(ones);
}

static void choose_caps(struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    const struct conjugate *vectors = &solver->beyond->descent.vectors;
    for (int64_t i = 0; i < vectors->leaf_count; i++) {
        int32_t leaf = vectors->leaves[i];
        struct rgb row_sum = leaf_irradiance(forest, leaf, solver->flux);
        caps_choose(&solver->beyond->caps, forest, leaf, row_sum.band[0]);
    }
}

/* Collective. Finds the bounds of struct descent on rows over all leaves of all ranks. */
static void bound_rows(struct solver *solver)
{
    const struct forest *forest = solver->model.forest;
    const double *factor = solver->beyond->caps.factor;
    struct descent *descent = &solver->beyond->descent;
    double bound[4] = {1.0, 0.0, 1.0, 0.0}; /* gain, shrink, weight, share */
    for (int64_t i = 0; i < descent->vectors.leaf_count; i++) {
        int32_t leaf = descent->vectors.leaves[i];
        double row_sum =
            factor[leaf] * leaf_irradiance(forest, leaf, solver->flux).band[0];
        struct rgb rho = forest_material(forest, leaf)->reflectance;
        double largest = fmax(rho.band[0], fmax(rho.band[1], rho.band[2]));
        double weight = 1.0 / factor[leaf];
        bound[0] = fmax(bound[0], row_sum);
        bound[1] = fmax(bound[1], row_sum * largest);
        bound[2] = fmax(bound[2], weight);
        bound[3] = fmax(bound[3], largest / weight);
    }
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, bound, 4, MPI_DOUBLE, MPI_MAX, solver->comm->handle,
                   &request);
    comm_wait(&request);
    descent->gain = bound[0];
    descent->shrink = bound[1];
    descent->weight = bound[2];
    descent->share = bound[3];
}

void caps_begin(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    caps_extend(&solver->beyond->caps, forest);
    conjugate_extend(&solver->beyond->descent.vectors, forest, solver->homes.own);
    solver->beyond->descent.fresh = true;
    carry_ones(solver);
    choose_caps(solver);
    bound_rows(solver);
}

/* The same, and leaves no trace in the accounts: it is not of the method. */
static void carry_ones_unseen(struct solver *solver)
{
    int64_t bytes = solver->account.bytes_gather, copied = solver->account.copied;
    double seconds[PHASE_COUNT];
    memcpy(seconds, solver->account.seconds, sizeof seconds);
    routes_renew(solver); /* a finished run that was resumed has none */
    carry_ones(solver);
    solver->account.bytes_gather = bytes;
    solver->account.copied = copied;
    memcpy(solver->account.seconds, seconds, sizeof seconds);
}

void solver_measure_row_sums(struct solver *solver, struct stats *stats)
{
    const struct comm *comm = solver->comm;
    double start = comm_seconds();
    carry_ones_unseen(solver);
    struct row_sums own =
        row_sums_measure(solver->model.forest, solver->homes.own, solver->flux);
    struct row_sums *all = comm_gather_each(comm, &own, sizeof own);
    struct row_sums sum = {.min = HUGE_VAL, .max = -HUGE_VAL};
    for (int r = 0; r < comm->size; r++) {
        sum.min = fmin(sum.min, all[r].min);
        sum.max = fmax(sum.max, all[r].max);
        sum.area = flux_add(sum.area, all[r].area);
        sum.rows = flux_add(sum.rows, all[r].rows);
        sum.squares = flux_add(sum.squares, all[r].squares);
    }
    alloc_free(all);
    double area = sum.area > 0 ? (double)sum.area : 1.0; /* 0: too small to count */
    stats->row_sum_min = sum.min;
    stats->row_sum_max = sum.max;
    stats->row_sum_mean = (double)sum.rows / area;
    stats->row_sum_rms = sqrt((double)sum.squares / area);
    solver->account.seconds[PHASE_ROW_SUMS] += comm_seconds() - start;
}
