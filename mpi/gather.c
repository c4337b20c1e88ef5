/* Step 5: light is transferred over the links, and what proxies received goes home.
 *
 * A rank's links add flux to patches of nearly all homes. One reduction adds up the flux
 * of all ranks, and each home gets the sums of its patches: integers, so in any order.
 * From P ranks to P homes that takes log P messages a rank, where one to each home would
 * take P - 1. */
#include "mpi/solver.h"

#include <math.h>
#include <string.h>

struct rgb *solver_vector(const struct solver *solver)
{
    return solver->steps.vector ? solver->steps.vector(solver)
                                : solver->model.forest->radiosity;
}

double solver_largest(const struct solver *solver, const struct rgb *vector)
{
    double largest = 1e-250;
    for (int64_t p = 0; p < solver->model.forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            largest = fmax(largest, fabs(vector[p].band[c]));
    return largest;
}

/* No patch receives more than all surfaces send where B is largest. */
void solver_transfer(struct solver *solver, const struct rgb *vector)
{
    double start = comm_seconds();
    solver->flux = flux_unit_for(solver_largest(solver, vector) * solver->model.area);
    solver->model.method.transfer(&solver->links, &solver->model, vector, solver->flux);
    solver->account.seconds[PHASE_SOLVE] += comm_seconds() - start;
}

/* Own patches keep their flux from the gather on; all others have given theirs away. */
static void clear_own_flux(struct solver *solver)
{
    const struct routes *routes = &solver->routes;
    const int32_t *own = routes->receivers + routes->receiver_at[solver->comm->rank];
    for (int i = 0; i < routes->receiver_counts[solver->comm->rank]; i++)
        for (int c = 0; c < BANDS; c++)
            solver->model.forest->patches[own[i]].flux[c] = 0;
}

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

static void bring_home(struct solver *solver)
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
    solver->account.seconds[PHASE_GATHER] += comm_seconds() - start;
}

void solver_carry(struct solver *solver, const struct rgb *vector)
{
    clear_own_flux(solver);
    solver->steps.transfer(solver, vector);
    bring_home(solver);
    if (solver->steps.collect)
        solver->steps.collect(solver);
}

void solver_gather(struct solver *solver)
{
    if (solver->turn.fresh) {
        double start = comm_seconds();
        routes_renew(solver);
        solver->account.seconds[PHASE_ROUTES] += comm_seconds() - start;
        if (solver->steps.begin)
            solver->steps.begin(solver);
    }
    solver->turn.fresh = false;
    solver_carry(solver, solver_vector(solver));
}
