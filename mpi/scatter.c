/* Step 7: the homes tell all ranks the radiosities of their leaves.
 *
 * All ranks know the trees since the end of refinement, and which leaves each is home to: so 24 bytes a
 * leaf are sent and nothing else, in the order of the routes. Inner patches get their means. */
#include "mpi/solver.h"

#include "geom/alloc.h"

void solver_scatter(struct solver *solver)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    const struct routes *routes = &solver->routes;
    struct forest *forest = solver->method.forest;
    int *at = alloc_array((size_t)comm->size, sizeof *at);
    int64_t count = comm_displacements(comm, routes->leaf_counts, at);
    int own_count = routes->leaf_counts[comm->rank], own_at = at[comm->rank];
    struct rgb *all = routes->radiosities;
    for (int i = own_at; i < own_at + own_count; i++)
        all[i] = forest->patches[routes->leaves[i]].radiosity;
    comm_share(comm, all, routes->leaf_counts, sizeof *all);
    for (int64_t i = 0; i < count; i++)
        forest->patches[routes->leaves[i]].radiosity = all[i];
    forest_average(forest);
    solver->bytes_scatter += own_count * (int64_t)sizeof *all * (comm->size - 1);
    alloc_free(at);
    solver->seconds[PHASE_SCATTER] += comm_seconds() - start;
}
