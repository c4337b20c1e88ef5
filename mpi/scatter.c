/* Step 7: the homes tell the ranks the radiosities of their leaves, and what they vote.
 *
 * All ranks know the trees since the end of refinement, and which leaves each is home to: so 24 bytes a
 * leaf are sent, in the order of the routes, the ballot of the home behind them, and nothing else. First
 * all of a row of the grid (mpi/routes.h) share what they have, then all of a column: for another transfer
 * over the same links their own, and the ballots of their rows, added up; for all else, what they have got
 * from their rows. Inner patches get their means. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

/* What the homes in rank's row share: the first record, and how many. */
static int row_at(const struct solver *solver, int rank)
{
    return solver->routes.record_at[rank - rank % solver->grid.columns];
}

static int row_count(const struct solver *solver, int rank)
{
    int first = rank - rank % solver->grid.columns;
    return solver->routes.record_at[first + solver->grid.columns] - row_at(solver, rank);
}

static struct rgb *ballot_of(const struct solver *solver, int home)
{
    return solver->routes.radiosities + solver->routes.record_at[home + 1] - BALLOT_RECORDS;
}

/* The radiosities of the own leaves, and the own ballot. */
static void pack(struct solver *solver)
{
    const struct routes *routes = &solver->routes;
    int rank = solver->comm->rank;
    const int32_t *leaves = routes->leaves + routes->leaf_at[rank];
    struct rgb *records = routes->radiosities + routes->record_at[rank];
    for (int i = 0; i < routes->leaf_counts[rank]; i++)
        records[i] = solver->method.forest->patches[leaves[i]].radiosity;
    memcpy(ballot_of(solver, rank), &solver->ballot, sizeof solver->ballot);
    solver->copied += routes->leaf_counts[rank];
}

/* Gives the leaves of a home what it has sent. */
static void renew_home(struct solver *solver, int home)
{
    const struct routes *routes = &solver->routes;
    struct forest *forest = solver->method.forest;
    const int32_t *leaves = routes->leaves + routes->leaf_at[home];
    const struct rgb *records = routes->radiosities + routes->record_at[home];
    for (int i = 0; i < routes->leaf_counts[home]; i++)
        forest->patches[leaves[i]].radiosity = records[i];
    const int32_t *patches = routes->receivers + routes->receiver_at[home]; /* children after parents */
    for (int i = routes->receiver_counts[home] - 1; i >= 0; i--)
        forest_average_patch(forest, patches[i]);
    solver->copied += routes->receiver_counts[home];
}

/* The sum of the ballots of `count` homes takes the place of solver->ballot. */
static void add_ballots(struct solver *solver, int first, int count, int step)
{
    struct ballot sum = {0}, ballot;
    for (int k = 0; k < count; k++) {
        memcpy(&ballot, ballot_of(solver, first + k * step), sizeof ballot);
        ballot_add(&sum, &ballot);
    }
    solver->ballot = sum;
}

/* The ranks of a part of the grid share records of theirs, from at[k] on. */
static void share(struct solver *solver, const struct comm *part, const int *counts, const int *at)
{
    comm_share(part, solver->routes.radiosities, counts, at, sizeof(struct rgb));
    for (int k = 0; k < part->size; k++)
        solver->bytes_scatter += k == part->rank ? 0 : counts[k] * (int64_t)sizeof(struct rgb);
}

static void share_in_row(struct solver *solver)
{
    const struct routes *routes = &solver->routes;
    const struct comm *row = routes_row(solver);
    int first = solver->comm->rank - row->rank;
    int *counts = alloc_array((size_t)row->size, sizeof *counts);
    for (int k = 0; k < row->size; k++)
        counts[k] = routes->leaf_counts[first + k] + BALLOT_RECORDS;
    share(solver, row, counts, routes->record_at + first);
    add_ballots(solver, first, row->size, 1);
    memcpy(ballot_of(solver, solver->comm->rank), &solver->ballot, sizeof solver->ballot);
    alloc_free(counts);
}

static void share_in_column(struct solver *solver, bool whole_rows)
{
    const struct routes *routes = &solver->routes;
    int columns = solver->grid.columns, first = solver->comm->rank % columns;
    size_t ranks = (size_t)solver->grid.rows;
    int *counts = alloc_array(2 * ranks, sizeof *counts), *at = counts + ranks;
    for (int k = 0; k < solver->grid.rows; k++) {
        int home = first + k * columns;
        counts[k] = whole_rows ? row_count(solver, home) : routes->leaf_counts[home] + BALLOT_RECORDS;
        at[k] = whole_rows ? row_at(solver, home) : routes->record_at[home];
    }
    share(solver, &solver->column, counts, at);
    add_ballots(solver, first, solver->grid.rows, columns);
    alloc_free(counts);
}

static void scatter(struct solver *solver, bool to_all)
{
    double start = comm_seconds();
    int rank = solver->comm->rank, columns = solver->grid.columns;
    pack(solver);
    share_in_row(solver);
    if (solver->grid.rows > 1)
        share_in_column(solver, to_all);
    for (int home = 0; home < solver->comm->size; home++)
        if (to_all || home / columns == rank / columns || home % columns == rank % columns)
            renew_home(solver, home);
    solver->seconds[PHASE_SCATTER] += comm_seconds() - start;
}

/* Jacobi refines after each iteration, and reads all radiosities then. */
void solver_scatter(struct solver *solver)
{
    scatter(solver, solver->method.criterion.solver == SOLVER_JACOBI);
}

void solver_scatter_to_all(struct solver *solver)
{
    solver->ballot = (struct ballot){0}; /* nobody votes on this */
    scatter(solver, true);
}
