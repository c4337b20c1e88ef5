/* Step 7: the homes tell all ranks the radiosities of their leaves, and their ballots.
 *
 * All ranks know the trees since the end of refinement, and which leaves each is home to:
 * so 24 bytes a leaf are sent, in the order of the routes, the ballot of the home behind
 * them, and nothing else. Inner patches get their means. */
#include "mpi/solver.h"

#include <string.h>

/* The place of a home's ballot in `radiosities`. */
static struct rgb *ballot_of(const struct routes *routes, int home)
{
    return routes->radiosities + routes->records.at[home + 1] - BALLOT_RECORDS;
}

/* Packs the radiosities of the own leaves, and the own ballot. */
static void pack(struct solver *solver, const struct rgb *vector)
{
    const struct routes *routes = &solver->routes;
    int rank = solver->comm->rank, count = routes->leaves.counts[rank];
    const int32_t *leaves = routes->leaves.patches + routes->leaves.at[rank];
    struct rgb *records = routes->radiosities + routes->records.at[rank];
    for (int i = 0; i < count; i++)
        records[i] = vector[leaves[i]];
    memcpy(ballot_of(routes, rank), &solver->ballot, sizeof solver->ballot);
    solver->account.copied += count;
}

/* Gives the leaves of a home the values that it has sent, and its inner patches their
 * means. */
static void renew_home(struct solver *solver, int home, struct rgb *vector)
{
    const struct routes *routes = &solver->routes;
    const int32_t *leaves = routes->leaves.patches + routes->leaves.at[home];
    const struct rgb *records = routes->radiosities + routes->records.at[home];
    for (int i = 0; i < routes->leaves.counts[home]; i++)
        vector[leaves[i]] = records[i];
    const struct route *all = &routes->receivers; /* children after parents */
    for (int i = all->at[home + 1] - 1; i >= all->at[home]; i--)
        patch_average(solver->model.forest, all->patches[i], vector);
    solver->account.copied += all->counts[home];
}

void solver_share(struct solver *solver, struct rgb *vector)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    const struct routes *routes = &solver->routes;
    const struct route *records = &routes->records;
    size_t bytes = sizeof *routes->radiosities;
    struct ballot sum = {0}, ballot;
    pack(solver, vector);
    comm_share(comm, routes->radiosities, records->counts, records->at, bytes);
    for (int home = 0; home < comm->size; home++) {
        renew_home(solver, home, vector);
        memcpy(&ballot, ballot_of(routes, home), sizeof ballot);
        ballot_add(&sum, &ballot);
    }
    solver->ballot = sum;
    solver->account.bytes_scatter +=
        (int64_t)bytes * (records->at[comm->size] - records->counts[comm->rank]);
    solver->account.seconds[PHASE_SCATTER] += comm_seconds() - start;
}

void solver_scatter(struct solver *solver)
{
    solver_share(solver, solver->model.forest->radiosity);
}
