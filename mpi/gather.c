/* Step 5: what proxies received goes home.
 *
 * A rank's links add flux to patches of the homes in its row and its column of the grid
 * (mpi/routes.h). One reduction over the row and one over the column add up what their ranks have, and
 * each home gets the sums of its patches: integers, so in any order. From P ranks to P homes that
 * takes log P messages a rank, where one to each home would take P - 1. */
#include "mpi/solver.h"

#include <string.h>

#include "geom/alloc.h"

/* Adds up what the ranks of a row or a column have for its homes, which are first, first + step ..., and
 * takes it from their patches. `own` receives the sums for this rank. */
static void add_up(struct solver *solver, const struct comm *part, int first, int step, int64_t *own)
{
    struct routes *routes = &solver->routes;
    struct patch *patches = solver->method.forest->patches;
    int *counts = alloc_array((size_t)part->size, sizeof *counts);
    int64_t count = 0;
    for (int k = 0; k < part->size; k++) {
        int home = first + k * step;
        counts[k] = routes->receiver_counts[home];
        for (int i = 0; i < counts[k]; i++) {
            int64_t *flux = patches[routes->receivers[routes->receiver_at[home] + i]].flux;
            memcpy(routes->flux + BANDS * count++, flux, sizeof patches->flux);
            memset(flux, 0, sizeof patches->flux);
        }
    }
    comm_add_home(part, routes->flux, counts, BANDS, own);
    solver->bytes_gather += (count - counts[part->rank]) * (int64_t)sizeof patches->flux;
    solver->copied += count;
    alloc_free(counts);
}

void solver_gather(struct solver *solver)
{
    double start = comm_seconds();
    const struct routes *routes = &solver->routes;
    int rank = solver->comm->rank, columns = solver->grid.columns;
    const int32_t *own = routes->receivers + routes->receiver_at[rank];
    add_up(solver, routes_row(solver), rank - rank % columns, 1, routes->own_flux[0]);
    if (solver->grid.rows > 1)
        add_up(solver, &solver->column, rank % columns, columns, routes->own_flux[1]);
    for (int i = 0; i < routes->receiver_counts[rank]; i++)
        for (int c = 0; c < BANDS; c++) {
            int64_t *flux = &solver->method.forest->patches[own[i]].flux[c];
            *flux = routes->own_flux[0][BANDS * i + c];
            *flux += solver->grid.rows > 1 ? routes->own_flux[1][BANDS * i + c] : 0;
        }
    solver->copied += routes->receiver_counts[rank];
    solver->seconds[PHASE_GATHER] += comm_seconds() - start;
}
