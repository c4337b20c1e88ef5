/* The routes.
 *
 * A link gives light to the same patches in every transfer (rad/link.h), so each rank goes over its links
 * once and marks them. The IDs of proxies among them go to their homes, once; later only flux does, in
 * the same order. Back home radiosities need no IDs at all, since all ranks know the trees and who is
 * home to which. */
#include "mpi/routes.h"

#include "geom/alloc.h"
#include "mpi/solver.h"

void routes_free(struct routes *routes)
{
    alloc_free(routes->out);
    alloc_free(routes->in);
    alloc_free(routes->leaves);
    alloc_free(routes->out_counts);
    alloc_free(routes->in_counts);
    alloc_free(routes->leaf_counts);
    *routes = (struct routes){0};
}

/* Marks what receives light when it is given to this patch. */
static void mark(const struct forest *forest, int32_t patch, const uint8_t parts[3], bool *marked)
{
    int32_t first = patch, count = 1;
    if (link_is_divided(forest, patch, parts)) {
        first = forest->patches[patch].children;
        count = 4;
    }
    for (int32_t k = 0; k < count; k++)
        marked[first + k] = true;
}

/* True for each patch that a link here gives light to. To be freed. */
static bool *mark_receivers(const struct solver *solver)
{
    const struct forest *forest = solver->method.forest;
    bool *marked = alloc_array((size_t)forest->count, sizeof *marked);
    for (int64_t i = 0; i < solver->links.seen; i++) {
        const struct link *link = &solver->links.items[i];
        mark(forest, link->p, link->parts_p, marked);
        mark(forest, link->q, link->parts_q, marked);
    }
    return marked;
}

/* Fills out and out_counts; returns their number. */
static int64_t list_leaving(struct solver *solver)
{
    const struct forest *forest = solver->method.forest;
    struct routes *routes = &solver->routes;
    bool *marked = mark_receivers(solver);
    int *at = alloc_array((size_t)solver->comm->size, sizeof *at);
    for (int64_t p = 0; p < forest->count; p++) {
        uint32_t root = forest->patches[p].id.root;
        marked[p] = marked[p] && !solver->own[root];
        routes->out_counts[solver->owner[root]] += marked[p];
    }
    int64_t count = comm_displacements(solver->comm, routes->out_counts, at);
    routes->out = alloc_array((size_t)count, sizeof *routes->out);
    for (int64_t p = 0; p < forest->count; p++)
        if (marked[p])
            routes->out[at[solver->owner[forest->patches[p].id.root]]++] = (int32_t)p;
    alloc_free(at);
    alloc_free(marked);
    return count;
}

/* Tells the homes, which look their patches up. */
static void announce(struct solver *solver, int64_t leaving)
{
    const struct comm *comm = solver->comm;
    struct forest *forest = solver->method.forest;
    struct routes *routes = &solver->routes;
    struct patch_id *ids = alloc_array((size_t)leaving, sizeof *ids);
    for (int64_t i = 0; i < leaving; i++)
        ids[i] = forest->patches[routes->out[i]].id;
    int64_t arriving = comm_exchange_counts(comm, routes->out_counts, routes->in_counts);
    struct patch_id *in = alloc_array((size_t)arriving, sizeof *in);
    comm_exchange_known(comm, ids, routes->out_counts, sizeof *ids, in, routes->in_counts);
    routes->in = alloc_array((size_t)arriving, sizeof *routes->in);
    for (int64_t i = 0; i < arriving; i++)
        routes->in[i] = forest_reach(forest, in[i]);
    solver->bytes_gather += leaving * (int64_t)sizeof *ids;
    alloc_free(in);
    alloc_free(ids);
}

/* What neither reflects nor emits stays 0. (A lamp that does not reflect is 0 too in the steps of conjugate
 * gradients, and E before and after.) Factors of --closure symmetric change everywhere. */
static bool can_change(const struct solver *solver, int32_t root)
{
    const struct scene *scene = solver->method.scene;
    return scene_root_area(scene, root) > 0.0 &&
           (solver->closure.kind == CLOSURE_SYMMETRIC ||
            !material_is_dark(scene_root_material(scene, root)));
}

static void list_leaves(struct solver *solver)
{
    const struct forest *forest = solver->method.forest;
    struct routes *routes = &solver->routes;
    int *at = alloc_array((size_t)solver->comm->size, sizeof *at);
    for (int64_t p = 0; p < forest->count; p++) {
        int32_t root = (int32_t)forest->patches[p].id.root;
        routes->leaf_counts[solver->owner[root]] += patch_is_leaf(&forest->patches[p]) &&
                                                    can_change(solver, root);
    }
    int64_t count = comm_displacements(solver->comm, routes->leaf_counts, at);
    routes->leaves = alloc_array((size_t)count, sizeof *routes->leaves);
    for (int32_t root = 0; root < forest->root_count; root++)
        for (int32_t p = root; p >= 0 && can_change(solver, root); p = forest_next(forest, p, true))
            if (patch_is_leaf(&forest->patches[p]))
                routes->leaves[at[solver->owner[root]]++] = p;
    alloc_free(at);
}

void routes_renew(struct solver *solver)
{
    link_list_sort(&solver->links);
    size_t ranks = (size_t)solver->comm->size;
    routes_free(&solver->routes);
    solver->routes.out_counts = alloc_array(ranks, sizeof *solver->routes.out_counts);
    solver->routes.in_counts = alloc_array(ranks, sizeof *solver->routes.in_counts);
    solver->routes.leaf_counts = alloc_array(ranks, sizeof *solver->routes.leaf_counts);
    announce(solver, list_leaving(solver));
    list_leaves(solver);
}
