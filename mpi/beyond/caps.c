/* Before light is transferred over new links: their row sums, and the caps on them
 * (rad/beyond/caps.h). B = 1 is transferred like light. */
#include "mpi/beyond/beyond.h"

#include <math.h>

#include "geom/alloc.h"

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
    solver_carry_ones(solver);
    choose_caps(solver);
    bound_rows(solver);
}
