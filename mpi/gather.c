/* Step 5: what proxies received goes home.
 *
 * A rank's links add flux to patches of all homes. Each proxy with flux is sent as (ID, flux);
 * the home adds: integers, so in any order. */
#include "mpi/solver.h"

#include "geom/alloc.h"

/* 32 bytes, no padding. */
struct wire_patch {
    struct patch_id id;
    int64_t flux[BANDS];
};

static bool must_go_home(const struct solver *solver, int64_t p)
{
    const struct patch *patch = &solver->method.forest->patches[p];
    return !solver->own[patch->id.root] &&
           (patch->flux[0] != 0 || patch->flux[1] != 0 || patch->flux[2] != 0);
}

/* Packs what goes home; `at` is where each home's records begin, and is used up. */
static struct wire_patch *pack_proxies(const struct solver *solver, int *at, int64_t total)
{
    const struct forest *forest = solver->method.forest;
    struct wire_patch *wire = alloc_array((size_t)total, sizeof *wire);
    for (int64_t p = 0; p < forest->count; p++) {
        if (!must_go_home(solver, p))
            continue;
        const struct patch *patch = &forest->patches[p];
        struct wire_patch *out = &wire[at[solver->owner[patch->id.root]]++];
        out->id = patch->id;
        for (int c = 0; c < BANDS; c++)
            out->flux[c] = patch->flux[c];
    }
    return wire;
}

static void add_to_home(struct forest *forest, const struct wire_patch *wire)
{
    int32_t p = forest_reach(forest, wire->id);
    for (int c = 0; c < BANDS; c++)
        forest->patches[p].flux[c] += wire->flux[c];
}

void solver_gather(struct solver *solver)
{
    double start = comm_seconds();
    const struct comm *comm = solver->comm;
    struct forest *forest = solver->method.forest;
    size_t ranks = (size_t)comm->size;
    int *counts = alloc_array(ranks, sizeof *counts), *at = alloc_array(ranks, sizeof *at);
    for (int64_t p = 0; p < forest->count; p++)
        if (must_go_home(solver, p))
            counts[solver->owner[forest->patches[p].id.root]]++;
    int64_t leaving = comm_displacements(comm, counts, at), arriving;
    struct wire_patch *out = pack_proxies(solver, at, leaving);
    struct wire_patch *in = comm_exchange(comm, out, counts, sizeof *out, &arriving);
    for (int64_t i = 0; i < arriving; i++)
        add_to_home(forest, &in[i]);
    solver->bytes_gather += leaving * (int64_t)sizeof *out;
    alloc_free(in);
    alloc_free(out);
    alloc_free(at);
    alloc_free(counts);
    solver->seconds[PHASE_GATHER] += comm_seconds() - start;
}
