/* Step 5: light is transferred over the links, and proxies send their flux home. A proxy
 * is the copy of a patch on a rank other than its home.
 *
 * A total exchange along the lists of mpi/scatter.c: homes add up the flux of their
 * patches' proxies. Flux is an integer, so the order does not matter.
 *
 * Rejected: a reduction of the flux of all patches, with log P messages for each rank in
 * place of up to P - 1, and several times the bytes. */
#include "mpi/solver.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

/* --- light over links --- */

double solver_largest(const struct solver *solver, const struct rgb *vector)
{
    const struct homes *homes = &solver->homes;
    double largest = 1e-250;
    for (int64_t i = 0; i < homes->count; i++)
        for (int c = 0; c < BANDS; c++)
            largest = fmax(largest, fabs(vector[homes->patches[i]].band[c]));
    return comm_largest(solver->comm, largest);
}

/* No patch receives more than all surfaces send where B is largest. */
void solver_transfer(struct solver *solver, const struct rgb *vector)
{
    account_begin(&solver->account, PHASE_SOLVE);
    solver->flux =
        flux_unit_for(solver_largest(solver, vector) * solver->model.whole_area);
    solver->model.method.transfer(&solver->links, &solver->model, vector, solver->flux);
    account_end(&solver->account, PHASE_SOLVE);
}

/* --- step 5 --- */

static int64_t *flux_of(const struct solver *solver, int32_t node)
{
    return node_is_cluster(node) ? solver->above.flux + BANDS * (int64_t)~node
                                 : solver->model.forest->patches[node].flux;
}

static void pack_flux(struct solver *solver, int32_t proxy, void *record)
{
    memcpy(record, flux_of(solver, proxy), BANDS * sizeof(int64_t));
}

static void add_flux(struct solver *solver, int32_t original, void *record)
{
    for (int c = 0; c < BANDS; c++)
        flux_of(solver, original)[c] += ((const int64_t *)record)[c];
}

/* Flux, from proxies to originals. */
static const struct record_kind FLUX = {CARGO_FLUX, BANDS * sizeof(int64_t), pack_flux,
                                        add_flux};

void solver_carry(struct solver *solver, const struct rgb *vector)
{
    struct patch *patches = solver->model.forest->patches;
    const struct homes *homes = &solver->homes;
    const struct route *proxies = &solver->routes.proxies;
    homes_renew(solver);
    for (int64_t i = 0; i < homes->count; i++)
        memset(patches[homes->patches[i]].flux, 0, sizeof patches->flux);
    for (int64_t i = 0; i < proxies->count; i++)
        memset(flux_of(solver, proxies->nodes[i]), 0, sizeof patches->flux);
    solver->steps.transfer(solver, vector);
    account_begin(&solver->account, PHASE_GATHER);
    routes_carry(solver, proxies, &solver->routes.originals, FLUX);
    account_end(&solver->account, PHASE_GATHER);
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
        account_begin(&solver->account, PHASE_SOLVE);
        link_list_sort(&solver->links);
        account_end(&solver->account, PHASE_SOLVE);
        account_begin(&solver->account, PHASE_ROUTES);
        routes_renew(solver);
        account_end(&solver->account, PHASE_ROUTES);
        if (solver->steps.begin)
            solver->steps.begin(solver);
    }
    solver->turn.fresh = false;
    solver_carry(solver, solver->model.forest->radiosity);
}

/* No part of the method: the transfer leaves no trace in the accounts. */
void solver_measure_row_sums(struct solver *solver, struct stats *stats)
{
    const struct comm *comm = solver->comm;
    account_begin(&solver->account, PHASE_ROW_SUMS);
    struct account before = solver->account;
    link_list_sort(&solver->links); /* those of a finished, resumed run are not */
    routes_renew(solver);
    solver_carry_ones(solver);
    solver->account = before;
    struct row_sums own =
        row_sums_measure(solver->model.forest, solver->homes.own, solver->flux);
    struct row_sums *all = comm_gather_each(comm, &own, sizeof own);
    struct row_sums sum = {.min = HUGE_VAL, .max = -HUGE_VAL};
    for (int r = 0; r < comm->size; r++) {
        sum.min = fmin(sum.min, all[r].min);
        sum.max = fmax(sum.max, all[r].max);
        sum.area = flux_add(sum.area, all[r].area);
        sum.rows = flux_add(sum.rows, all[r].rows);
        sum.squares = flux_add(sum.squares, all[r].squares);
    }
    alloc_free(all);
    double area = sum.area > 0 ? (double)sum.area : 1.0; /* 0: too small to count */
    bool any = sum.min <= sum.max;
    stats->row_sum_min = any ? sum.min : 0.0;
    stats->row_sum_max = any ? sum.max : 0.0;
    stats->row_sum_mean = (double)sum.rows / area;
    stats->row_sum_rms = sqrt((double)sum.squares / area);
    account_end(&solver->account, PHASE_ROW_SUMS);
}
