/* Step 7: the homes tell all ranks the radiosities of their leaves, and what they vote.
 *
 * All ranks know the trees since the end of refinement, and which leaves each is home to: so 24 bytes a
 * leaf are sent, in the order of the routes, the ballot of the home behind them, and nothing else. Inner
 * patches get their means. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

/* The radiosities of the own leaves, and the own ballot. */
static void pack(const struct solver *solver, const int32_t *leaves, int count, struct rgb *records)
{
    for (int i = 0; i < count; i++)
        records[i] = solver->method.forest->patches[leaves[i]].radiosity;
    memcpy(records + count, &solver->ballots[solver->comm->rank], sizeof *solver->ballots);
}

static void unpack(struct solver *solver)
{
    const struct routes *routes = &solver->routes;
    struct patch *patches = solver->method.forest->patches;
    const struct rgb *records = routes->radiosities;
    const int32_t *leaf = routes->leaves;
    for (int r = 0; r < solver->comm->size; r++) {
        for (int i = 0; i < routes->leaf_counts[r]; i++)
            patches[*leaf++].radiosity = *records++;
        memcpy(&solver->ballots[r], records, sizeof *solver->ballots);
        records += BALLOT_RECORDS;
    }
}

void solver_scatter(struct solver *solver)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    const struct routes *routes = &solver->routes;
    int *counts = alloc_array(2 * (size_t)comm->size, sizeof *counts), *at = counts + comm->size;
    for (int r = 0; r < comm->size; r++)
        counts[r] = routes->leaf_counts[r] + BALLOT_RECORDS;
    comm_displacements(comm, counts, at);
    int own_at = at[comm->rank], leaf_at = own_at - BALLOT_RECORDS * comm->rank;
    pack(solver, routes->leaves + leaf_at, routes->leaf_counts[comm->rank], routes->radiosities + own_at);
    comm_share(comm, routes->radiosities, counts, sizeof *routes->radiosities);
    unpack(solver);
    forest_average(solver->method.forest);
    solver->bytes_scatter += counts[comm->rank] * (int64_t)sizeof(struct rgb) * (comm->size - 1);
    alloc_free(counts);
    solver->seconds[PHASE_SCATTER] += comm_seconds() - start;
}
