/* Step 5: what proxies received goes home.
 *
 * A rank's links add flux to patches of nearly all homes. One reduction adds up the flux
 * of all ranks, and each home gets the sums of its patches: integers, so in any order.
 * From P ranks to P homes that takes log P messages a rank, where one to each home would
 * take P - 1. */
#include "mpi/beyond/beyond.h"

#include <string.h>

/* Takes the flux of all patches that can receive light; returns their number. */
static int64_t take_flux(struct solver *solver)
{
    struct routes *routes = &solver->routes;
    struct patch *patches = solver->model.forest->patches;
    int64_t count = 0;
    for (int r = 0; r < solver->comm->size; r++)
        count += routes->receiver_counts[r];
    for (int64_t i = 0; i < count; i++) {
        int64_t *flux = patches[routes->receivers[i]].flux;
        memcpy(routes->flux + BANDS * i, flux, sizeof patches->flux);
        memset(flux, 0, sizeof patches->flux);
    }
    return count;
}

/* All ranks get the sums of the flux of all clusters: a reduction and its result sent back. */
static void gather_clusters(struct solver *solver)
{
    struct cluster_light *clusters = solver->model.clusters;
    int64_t count = BANDS * (int64_t)solver->beyond->tree->count;
    comm_add(solver->comm, clusters->flux, count);
    if (solver->comm->size > 1)
        solver->account.bytes_gather += 2 * count * (int64_t)sizeof *clusters->flux;
    double start = comm_seconds();
    cluster_light_push(clusters, solver->model.forest, solver->flux);
    double pushing = comm_seconds() - start;
    solver->account.seconds[PHASE_SUMS] += pushing;
    solver->account.seconds[PHASE_GATHER] -= pushing;
}

void solver_gather(struct solver *solver)
{
    double start = comm_seconds();
    const struct routes *routes = &solver->routes;
    struct patch *patches = solver->model.forest->patches;
    int rank = solver->comm->rank, own_count = routes->receiver_counts[rank];
    const int32_t *own = routes->receivers + routes->receiver_at[rank];
    int64_t count = take_flux(solver);
    comm_add_home(solver->comm, routes->flux, routes->receiver_counts, BANDS,
                  routes->own_flux);
    for (int i = 0; i < own_count; i++)
        memcpy(patches[own[i]].flux, routes->own_flux + BANDS * i, sizeof patches->flux);
    solver->account.bytes_gather += (count - own_count) * (int64_t)sizeof patches->flux;
    solver->account.copied += count + own_count;
    if (solver->beyond->tree)
        gather_clusters(solver);
    solver->account.seconds[PHASE_GATHER] += comm_seconds() - start;
}
