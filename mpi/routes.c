/* The routes: since all ranks know the trees and who is home to which, each finds them by
 * itself. */
#include "mpi/routes.h"

#include "geom/alloc.h"
#include "mpi/solver.h"

void routes_free(struct routes *routes)
{
    alloc_free(routes->receivers);
    alloc_free(routes->leaves);
    alloc_free(routes->receiver_counts);
    alloc_free(routes->leaf_counts);
    alloc_free(routes->receiver_at);
    alloc_free(routes->leaf_at);
    alloc_free(routes->record_at);
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

/* What neither reflects nor emits stays 0. (A lamp that does not reflect is 0 too in the
 * steps of conjugate gradients, and E before and after.) */
static bool is_leaf_that_changes(const struct solver *solver, int32_t patch)
{
    const struct patch *at = &solver->model.forest->patches[patch];
    return patch_is_leaf(at) && can_receive(solver, patch) &&
           !material_is_dark(forest_material(solver->model.forest, patch));
}

/* The patches for which `is_listed` is true, home by home; how many each has, and where
 * they begin. Returns their number too. */
static int32_t *list_patches(const struct solver *solver,
                             bool (*is_listed)(const struct solver *, int32_t),
                             int *counts, int *at, int64_t *count)
{
    const struct forest *forest = solver->model.forest;
    for (int64_t p = 0; p < forest->count; p++)
        counts[solver->homes.owner[forest->patches[p].id.root]] +=
            is_listed(solver, (int32_t)p);
    *count = comm_displacements(solver->comm, counts, at);
    int32_t *list = alloc_array((size_t)*count, sizeof *list);
    for (int32_t root = 0; root < forest->root_count; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (is_listed(solver, p))
                list[at[solver->homes.owner[root]]++] = p;
    comm_displacements(solver->comm, counts, at);
    return list;
}

void routes_renew(struct solver *solver)
{
    struct routes *routes = &solver->routes;
    size_t ranks = (size_t)solver->comm->size;
    link_list_sort(&solver->links);
    routes_free(routes);
    routes->receiver_counts = alloc_array(ranks, sizeof *routes->receiver_counts);
    routes->leaf_counts = alloc_array(ranks, sizeof *routes->leaf_counts);
    routes->receiver_at = alloc_array(ranks, sizeof *routes->receiver_at);
    routes->leaf_at = alloc_array(ranks, sizeof *routes->leaf_at);
    routes->record_at = alloc_array(ranks + 1, sizeof *routes->record_at);
    int64_t receivers, leaves;
    routes->receivers = list_patches(solver, can_receive, routes->receiver_counts,
                                     routes->receiver_at, &receivers);
    routes->leaves = list_patches(solver, is_leaf_that_changes, routes->leaf_counts,
                                  routes->leaf_at, &leaves);
    int64_t records = leaves + BALLOT_RECORDS * (int64_t)ranks;
    routes->record_at[ranks] = comm_count(solver->comm, records);
    for (size_t r = 0; r < ranks; r++)
        routes->record_at[r] = routes->leaf_at[r] + BALLOT_RECORDS * (int)r;
    size_t own = (size_t)routes->receiver_counts[solver->comm->rank];
    routes->flux = alloc_array(BANDS * (size_t)receivers, sizeof *routes->flux);
    routes->own_flux = alloc_array(BANDS * own, sizeof *routes->own_flux);
    routes->radiosities = alloc_array((size_t)records, sizeof *routes->radiosities);
}
