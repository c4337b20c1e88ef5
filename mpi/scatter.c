/* Step 7: the homes tell all ranks the radiosities of their leaves, and what they vote.
 *
 * All ranks know the trees since the end of refinement, and which leaves each is home to:
 * so 24 bytes a leaf are sent, in the order of the routes, the ballot of the home behind
 * them, and nothing else. Inner patches get their means. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

static struct rgb *ballot_of(const struct solver *solver, int home)
{
    return solver->routes.radiosities + solver->routes.record_at[home + 1] -
           BALLOT_RECORDS;
}

/* The radiosities of the own leaves, and the own ballot. */
static void pack(struct solver *solver, const struct rgb *vector)
{
    const struct routes *routes = &solver->routes;
    int rank = solver->comm->rank;
    const int32_t *leaves = routes->leaves + routes->leaf_at[rank];
    struct rgb *records = routes->radiosities + routes->record_at[rank];
    for (int i = 0; i < routes->leaf_counts[rank]; i++)
        records[i] = vector[leaves[i]];
    memcpy(ballot_of(solver, rank), &solver->ballot, sizeof solver->ballot);
    solver->account.copied += routes->leaf_counts[rank];
}

/* Gives the leaves of a home what it has sent. */
static void renew_home(struct solver *solver, int home, struct rgb *vector)
{
    const struct routes *routes = &solver->routes;
    const struct forest *forest = solver->model.forest;
    const int32_t *leaves = routes->leaves + routes->leaf_at[home];
    const struct rgb *records = routes->radiosities + routes->record_at[home];
    for (int i = 0; i < routes->leaf_counts[home]; i++)
        vector[leaves[i]] = records[i];
    const int32_t *patches =
        routes->receivers + routes->receiver_at[home]; /* children after parents */
    for (int i = routes->receiver_counts[home] - 1; i >= 0; i--)
        patch_average(forest, patches[i], vector);
    solver->account.copied += routes->receiver_counts[home];
}

/* The sum of the ballots of all homes takes the place of this rank's. */
static void add_ballots(struct solver *solver)
{
    struct ballot sum = {0}, ballot;
    for (int home = 0; home < solver->comm->size; home++) {
        memcpy(&ballot, ballot_of(solver, home), sizeof ballot);
        ballot_add(&sum, &ballot);
    }
    solver->ballot = sum;
}

/* The homes share their records. */
static void share(struct solver *solver)
{
    const struct routes *routes = &solver->routes;
    const struct comm *comm = solver->comm;
    int *counts = alloc_array((size_t)comm->size, sizeof *counts);
    for (int home = 0; home < comm->size; home++) {
        counts[home] = routes->leaf_counts[home] + BALLOT_RECORDS;
        if (home != comm->rank)
            solver->account.bytes_scatter +=
                counts[home] * (int64_t)sizeof *routes->radiosities;
    }
    comm_share(comm, routes->radiosities, counts, routes->record_at,
               sizeof *routes->radiosities);
    alloc_free(counts);
}

void solver_scatter(struct solver *solver)
{
    double start = comm_seconds();
    struct rgb *vector = solver_vector(solver);
    pack(solver, vector);
    share(solver);
    add_ballots(solver);
    for (int home = 0; home < solver->comm->size; home++)
        renew_home(solver, home, vector);
    solver->account.seconds[PHASE_SCATTER] += comm_seconds() - start;
}
