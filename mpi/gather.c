/* Step 5: light is transferred over the links, and proxies with new flux go home. A proxy
 * is the copy of a patch on a rank other than its home.
 *
 * A total exchange: each rank tells each home which of its patches have received flux
 * over the rank's links, and how much; homes add up the amounts. Flux is an integer, so
 * the order does not matter.
 *
 * Rejected: a reduction of the flux of all patches, with log P messages for each rank in
 * place of up to P - 1. In a room of 1,004 triangles (--paper) a reduction has 1.2 times
 * the bytes on 2 ranks, 2.1 times on 8, 4.3 times on 32. */
#include "mpi/solver.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

/* --- light over links --- */

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
    solver->flux =
        flux_unit_for(solver_largest(solver, vector) * solver->model.whole_area);
    solver->model.method.transfer(&solver->links, &solver->model, vector, solver->flux);
    solver->account.seconds[PHASE_SOLVE] += comm_seconds() - start;
}

/* --- step 5 --- */

/* The flux of a proxy on its way home; 32 bytes, no padding. */
struct wire_flux {
    struct patch_id id;
    int64_t flux[BANDS];
};

/* True of a proxy with new flux. */
static bool is_updated(const struct solver *solver, int64_t p)
{
    static const int64_t NOTHING[BANDS];
    const struct patch *patch = &solver->model.forest->patches[p];
    return !solver->homes.own[patch->id.root] &&
           memcmp(patch->flux, NOTHING, sizeof NOTHING) != 0;
}

/* Packs the proxies to be sent, home by home: counts[h] go to rank h. */
static struct wire_flux *pack_proxies(const struct solver *solver, int *counts)
{
    const struct forest *forest = solver->model.forest;
    const int *owner = solver->homes.owner;
    int *at = alloc_array((size_t)solver->comm->size, sizeof *at);
    for (int64_t p = 0; p < forest->count; p++)
        counts[owner[forest->patches[p].id.root]] += is_updated(solver, p);
    int64_t all = comm_displacements(solver->comm, counts, at);
    struct wire_flux *wire = alloc_array((size_t)all, sizeof *wire);
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        if (!is_updated(solver, p))
            continue;
        struct wire_flux *to = &wire[at[owner[patch->id.root]]++];
        to->id = patch->id;
        memcpy(to->flux, patch->flux, sizeof to->flux);
    }
    alloc_free(at);
    return wire;
}

/* Collective. Own patches get the flux of all their proxies. Pre: all ranks have the same
 * trees. */
static void bring_home(struct solver *solver)
{
    double start = comm_seconds();
    struct forest *forest = solver->model.forest;
    struct account *account = &solver->account;
    int *counts = alloc_array((size_t)solver->comm->size, sizeof *counts);
    int64_t arriving, messages = comm_counts().messages;
    struct wire_flux *out = pack_proxies(solver, counts);
    struct wire_flux *in =
        comm_exchange(solver->comm, out, counts, sizeof *out, &arriving);
    for (int64_t i = 0; i < arriving; i++) {
        struct patch *patch = &forest->patches[forest_reach(forest, in[i].id)];
        for (int c = 0; c < BANDS; c++)
            patch->flux[c] += in[i].flux[c];
    }
    for (int r = 0; r < solver->comm->size; r++) {
        account->bytes[CARGO_FLUX] += counts[r] * (int64_t)sizeof *out;
        account->copied += counts[r];
    }
    account->copied += arriving;
    account->messages[CARGO_FLUX] += comm_counts().messages - messages;
    alloc_free(in);
    alloc_free(out);
    alloc_free(counts);
    account->seconds[PHASE_GATHER] += comm_seconds() - start;
}

void solver_carry(struct solver *solver, const struct rgb *vector)
{
    struct forest *forest = solver->model.forest;
    for (int64_t p = 0; p < forest->count; p++)
        memset(forest->patches[p].flux, 0, sizeof forest->patches->flux);
    solver->steps.transfer(solver, vector);
    bring_home(solver);
    if (solver->steps.collect)
        solver->steps.collect(solver);
}

void solver_carry_ones(struct solver *solver)
{
    size_t count = (size_t)solver->model.forest->count;
    struct rgb *ones = alloc_array(count, sizeof *ones);
    for (size_t p = 0; p < count; p++)
        ones[p] = (struct rgb){{1.0, 0.0, 0.0}};
    solver_carry(solver, ones);
    alloc_free(ones);
}

void solver_gather(struct solver *solver)
{
    if (solver->turn.fresh) {
        double start = comm_seconds();
        link_list_sort(&solver->links);
        solver->account.seconds[PHASE_SOLVE] += comm_seconds() - start;
        start = comm_seconds();
        routes_renew(solver);
        solver->account.seconds[PHASE_ROUTES] += comm_seconds() - start;
        if (solver->steps.begin)
            solver->steps.begin(solver);
    }
    solver->turn.fresh = false;
    solver_carry(solver, solver->model.forest->radiosity);
}
