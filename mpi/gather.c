/* Step 5: light is transferred over the links, and flux that proxies received goes home.
 * A proxy is the copy of a patch on a rank that is not its home.
 *
 * A rank's links add flux to patches of nearly all homes. One reduction adds up the flux
 * of all ranks, and each home gets the sums of its patches: integers, so in any order.
 * From P ranks to P homes that takes log P messages a rank, where one to each home would
 * take P - 1.
 *
 * Which patches travel follows from the trees and from the homes, which all ranks know:
 * each finds the routes by itself. */
#include "mpi/solver.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"

/* --- routes --- */

void routes_free(struct routes *routes)
{
    struct route *all[] = {&routes->receivers, &routes->leaves, &routes->records};
    for (int k = 0; k < 3; k++) {
        alloc_free(all[k]->patches);
        alloc_free(all[k]->counts);
        alloc_free(all[k]->at);
    }
    alloc_free(routes->flux);
    alloc_free(routes->own_flux);
    alloc_free(routes->radiosities);
    *routes = (struct routes){0};
}

static bool can_receive(const struct solver *solver, int32_t patch)
{
    uint32_t root = solver->model.forest->patches[patch].id.root;
    return scene_root_area(solver->model.scene, (int32_t)root) > 0.0;
}

/* A dark leaf stays at 0. */
static bool is_leaf_that_changes(const struct solver *solver, int32_t patch)
{
    const struct patch *at = &solver->model.forest->patches[patch];
    return patch_is_leaf(at) && can_receive(solver, patch) &&
           !material_is_dark(forest_material(solver->model.forest, patch));
}

/* The patches for which `is_listed` is true. */
static struct route list_patches(const struct solver *solver,
                                 bool (*is_listed)(const struct solver *, int32_t))
{
    const struct forest *forest = solver->model.forest;
    const struct comm *comm = solver->comm;
    const int *owner = solver->homes.owner;
    struct route route = {.patches = NULL};
    route.counts = alloc_array((size_t)comm->size, sizeof *route.counts);
    route.at = alloc_array((size_t)comm->size + 1, sizeof *route.at);
    for (int64_t p = 0; p < forest->count; p++)
        route.counts[owner[forest->patches[p].id.root]] +=
            is_listed(solver, (int32_t)p);
    int count = (int)comm_displacements(comm, route.counts, route.at);
    route.patches = alloc_array((size_t)count, sizeof *route.patches);
    for (int32_t root = 0; root < forest->root_count; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (is_listed(solver, p))
                route.patches[route.at[owner[root]]++] = p;
    route.at[comm->size] = (int)comm_displacements(comm, route.counts, route.at);
    return route;
}

void routes_renew(struct solver *solver)
{
    struct routes *routes = &solver->routes;
    int ranks = solver->comm->size;
    if (routes->trees == solver->model.forest->count)
        return;
    routes_free(routes);
    routes->trees = solver->model.forest->count;
    routes->receivers = list_patches(solver, can_receive);
    routes->leaves = list_patches(solver, is_leaf_that_changes);
    struct route *records = &routes->records;
    records->counts = alloc_array((size_t)ranks, sizeof *records->counts);
    records->at = alloc_array((size_t)ranks + 1, sizeof *records->at);
    for (int home = 0; home < ranks; home++)
        records->counts[home] = routes->leaves.counts[home] + BALLOT_RECORDS;
    records->at[ranks] =
        (int)comm_displacements(solver->comm, records->counts, records->at);
    size_t receivers = (size_t)routes->receivers.at[ranks];
    size_t own = (size_t)routes->receivers.counts[solver->comm->rank];
    routes->flux = alloc_array(BANDS * receivers, sizeof *routes->flux);
    routes->own_flux = alloc_array(BANDS * own, sizeof *routes->own_flux);
    routes->radiosities = alloc_array((size_t)records->at[ranks],
                                      sizeof *routes->radiosities);
}

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

static void bring_home(struct solver *solver)
{
    double start = comm_seconds();
    const struct routes *routes = &solver->routes;
    const struct route *receivers = &routes->receivers;
    struct patch *patches = solver->model.forest->patches;
    int all = receivers->at[solver->comm->size];
    int own = receivers->counts[solver->comm->rank];
    for (int i = 0; i < all; i++)
        memcpy(routes->flux + BANDS * (size_t)i, patches[receivers->patches[i]].flux,
               sizeof patches->flux);
    comm_add_home(solver->comm, routes->flux, receivers->counts, BANDS,
                  routes->own_flux);
    const int32_t *homecomers = receivers->patches + receivers->at[solver->comm->rank];
    for (int i = 0; i < own; i++)
        memcpy(patches[homecomers[i]].flux, routes->own_flux + BANDS * (size_t)i,
               sizeof patches->flux);
    solver->account.bytes_gather += (all - own) * (int64_t)sizeof patches->flux;
    solver->account.copied += (int64_t)all + own;
    solver->account.seconds[PHASE_GATHER] += comm_seconds() - start;
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
