/* Step 7: the homes tell all ranks the radiosities of their leaves, and their ballots.
 *
 * All ranks know the trees since the end of refinement, and which leaves each is home to:
 * so 24 bytes a leaf are sent, in the order of the routes, the ballot of the home behind
 * them, and nothing else. Inner patches get their means. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

/* --- routes --- */

void routes_free(struct routes *routes)
{
    alloc_free(routes->leaves);
    alloc_free(routes->counts);
    alloc_free(routes->at);
    alloc_free(routes->radiosities);
    *routes = (struct routes){0};
}

/* The next leaf of all trees whose B can change: a dark one stays at 0. */
static int32_t next_leaf(const struct forest *forest, int32_t leaf)
{
    do
        leaf = forest_next_leaf(forest, leaf);
    while (leaf >= 0 && material_is_dark(forest_material(forest, leaf)));
    return leaf;
}

void routes_renew(struct solver *solver)
{
    struct routes *routes = &solver->routes;
    const struct forest *forest = solver->model.forest;
    const int *owner = solver->homes.owner;
    int ranks = solver->comm->size;
    if (routes->trees == forest->count)
        return;
    routes_free(routes);
    routes->trees = forest->count;
    routes->counts = alloc_array((size_t)ranks, sizeof *routes->counts);
    routes->at = alloc_array((size_t)ranks + 1, sizeof *routes->at);
    int32_t *leaves = alloc_array((size_t)forest->count, sizeof *leaves), count = 0;
    for (int32_t p = next_leaf(forest, -1); p >= 0; p = next_leaf(forest, p)) {
        routes->counts[owner[forest->patches[p].id.root]]++;
        leaves[count++] = p;
    }
    for (int home = 0; home < ranks; home++)
        routes->counts[home] += BALLOT_RECORDS;
    size_t all = (size_t)comm_displacements(solver->comm, routes->counts, routes->at);
    routes->leaves = alloc_array(all, sizeof *routes->leaves);
    routes->radiosities = alloc_array(all, sizeof *routes->radiosities);
    for (int32_t i = 0; i < count; i++)
        routes->leaves[routes->at[owner[forest->patches[leaves[i]].id.root]]++] =
            leaves[i];
    alloc_free(leaves);
    routes->at[ranks] = (int)comm_displacements(solver->comm, routes->counts, routes->at);
}

/* --- step 7 --- */

/* The place of a home's ballot in `radiosities`. */
static struct rgb *ballot_of(const struct routes *routes, int home)
{
    return routes->radiosities + routes->at[home + 1] - BALLOT_RECORDS;
}

/* Packs the radiosities of the own leaves, and the own ballot. */
static void pack(struct solver *solver, const struct rgb *vector)
{
    const struct routes *routes = &solver->routes;
    int rank = solver->comm->rank, end = routes->at[rank] + routes_leaves(routes, rank);
    for (int i = routes->at[rank]; i < end; i++)
        routes->radiosities[i] = vector[routes->leaves[i]];
    memcpy(ballot_of(routes, rank), &solver->ballot, sizeof solver->ballot);
    solver->account.copied += routes_leaves(routes, rank);
}

/* Gives the leaves of a home the values received from there. */
static void renew_home(struct solver *solver, int home, struct rgb *vector)
{
    const struct routes *routes = &solver->routes;
    int end = routes->at[home] + routes_leaves(routes, home);
    for (int i = routes->at[home]; i < end; i++)
        vector[routes->leaves[i]] = routes->radiosities[i];
    solver->account.copied += routes_leaves(routes, home);
}

void solver_share(struct solver *solver, struct rgb *vector)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    const struct routes *routes = &solver->routes;
    size_t bytes = sizeof *routes->radiosities;
    int64_t messages = comm_counts().messages;
    struct ballot sum = {0}, ballot;
    pack(solver, vector);
    comm_share(comm, routes->radiosities, routes->counts, routes->at, bytes);
    for (int home = 0; home < comm->size; home++) {
        renew_home(solver, home, vector);
        memcpy(&ballot, ballot_of(routes, home), sizeof ballot);
        ballot_add(&sum, &ballot);
    }
    for (int64_t p = solver->model.forest->count - 1; p >= 0; p--)
        patch_average(solver->model.forest, (int32_t)p, vector);
    solver->ballot = sum;
    solver->account.bytes[CARGO_LIGHT] +=
        (int64_t)bytes * (routes->at[comm->size] - routes->counts[comm->rank]);
    solver->account.messages[CARGO_LIGHT] += comm_counts().messages - messages;
    solver->account.seconds[PHASE_SCATTER] += comm_seconds() - start;
}

void solver_scatter(struct solver *solver)
{
    solver_share(solver, solver->model.forest->radiosity);
}
