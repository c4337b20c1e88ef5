/* Step 5: what proxies received goes home.
 *
 * A rank's links add flux to patches of all homes. One reduction adds up what all ranks have, and each
 * home gets the sums of its patches: integers, so in any order. From P ranks to P homes that takes log P
 * messages a rank, where one to each home would take P - 1, and about as many bytes: the links of a rank
 * lead nearly everywhere. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

void solver_gather(struct solver *solver)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    const struct routes *routes = &solver->routes;
    struct patch *patches = solver->method.forest->patches;
    int *at = alloc_array((size_t)comm->size, sizeof *at);
    int64_t count = comm_displacements(comm, routes->receiver_counts, at);
    int64_t own_count = routes->receiver_counts[comm->rank];
    const int32_t *own_patches = routes->receivers + at[comm->rank];
    int64_t *all = routes->flux, *own = routes->own_flux;
    for (int64_t i = 0; i < count; i++)
        memcpy(all + BANDS * i, patches[routes->receivers[i]].flux, sizeof patches->flux);
    comm_add_home(comm, all, routes->receiver_counts, BANDS, own);
    for (int64_t i = 0; i < own_count; i++)
        memcpy(patches[own_patches[i]].flux, own + BANDS * i, sizeof patches->flux);
    solver->bytes_gather += (count - own_count) * (int64_t)(BANDS * sizeof *all);
    alloc_free(at);
    solver->seconds[PHASE_GATHER] += comm_seconds() - start;
}
