/* Step 5: what proxies received goes home.
 *
 * A rank's links add flux to patches of all homes. The flux of each proxy is sent, in the order of the
 * routes; the home adds: integers, so in any order. */
#include "mpi/solver.h"

#include "geom/alloc.h"

/* 24 bytes, no padding. */
struct wire_flux {
    int64_t flux[BANDS];
};

static int64_t sum_of(const int *counts, int ranks)
{
    int64_t sum = 0;
    for (int r = 0; r < ranks; r++)
        sum += counts[r];
    return sum;
}

void solver_gather(struct solver *solver)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    const struct routes *routes = &solver->routes;
    struct patch *patches = solver->method.forest->patches;
    int64_t leaving = sum_of(routes->out_counts, comm->size);
    int64_t arriving = sum_of(routes->in_counts, comm->size);
    struct wire_flux *out = alloc_array((size_t)leaving, sizeof *out);
    struct wire_flux *in = alloc_array((size_t)arriving, sizeof *in);
    for (int64_t i = 0; i < leaving; i++)
        for (int c = 0; c < BANDS; c++)
            out[i].flux[c] = patches[routes->out[i]].flux[c];
    comm_exchange_known(comm, out, routes->out_counts, sizeof *out, in, routes->in_counts);
    for (int64_t i = 0; i < arriving; i++)
        for (int c = 0; c < BANDS; c++)
            patches[routes->in[i]].flux[c] += in[i].flux[c];
    solver->bytes_gather += leaving * (int64_t)sizeof *out;
    alloc_free(in);
    alloc_free(out);
    solver->seconds[PHASE_GATHER] += comm_seconds() - start;
}
