/* The tree above the roots: built by rank 0, and sent like the octree (mpi/broadcast.c).
 *
 * The tree is dealt by branches: a cluster and all below are at home on one rank. There
 * the radiosities of these clusters are averaged, and irradiance is handed down. Other
 * ranks have proxies of these, at the ends of their links, as of patches (mpi/scatter.c).
 * The clusters above all branches, some hundred, are on all ranks: the radiosities of the
 * branches go to all, and the flux of these clusters is summed over all. Averages are the
 * same sums whoever computes them. */
#include "mpi/beyond/above.h"

#include <string.h>

#include "geom/alloc.h"
#include "mpi/assign.h"
#include "mpi/beyond/beyond.h"

/* --- building --- */

static int32_t *places_gather(const struct comm *comm, const struct scene *scene,
                              const struct octree *octree)
{
    int64_t all = scene_root_count(scene);
    int32_t first = (int32_t)(all * comm->rank / comm->size);
    int32_t end = (int32_t)(all * (comm->rank + 1) / comm->size);
    int32_t *own = places_met(scene, octree, first, end);
    int64_t count = space_rays(scene) * (int64_t)(end - first);
    void *met = comm_gather_all(comm, own, count, sizeof *own, &count);
    alloc_free(own);
    return met;
}

static struct node_block tree_broadcast(const struct comm *comm,
                                        struct node_policy policy,
                                        const struct scene *scene,
                                        const struct spaces *spaces,
                                        struct cluster_tree **tree)
{
    struct node_block block = {.data = NULL};
    struct pack count = {0};
    double start = comm_seconds();
    *tree = comm->rank == 0 ? cluster_tree_build(scene, spaces) : NULL;
    double seconds = comm_seconds() - start;
    block.seconds = seconds;
    if (comm->size == 1)
        return block;
    if (comm->rank == 0)
        cluster_tree_pack(*tree, &count);
    comm_broadcast(comm, &count.bytes, sizeof count.bytes);
    node_block_create(&block, comm, count.bytes, policy);
    if (comm->rank == 0) {
        cluster_tree_pack(*tree, &(struct pack){.block = block.data, .writes = true});
        cluster_tree_destroy(*tree);
    }
    node_block_spread(&block, comm);
    block.seconds = seconds;
    *tree = cluster_tree_view(&(struct pack){.block = block.data});
    return block;
}

void above_create(struct solver *solver)
{
    const struct comm *comm = solver->comm;
    const struct scene *scene = solver->model.scene;
    struct beyond *beyond = solver->beyond;
    account_begin(&solver->account, PHASE_SPACES);
    beyond->branches = alloc_array(1, sizeof *beyond->branches);
    int32_t *met = solver->model.octree ? places_gather(comm, scene, solver->model.octree)
                                        : NULL;
    beyond->spaces = spaces_create(scene, met);
    alloc_free(met);
    account_end(&solver->account, PHASE_SPACES);
    beyond->tree_block =
        tree_broadcast(comm, node_policy(), scene, beyond->spaces, &beyond->tree);
    solver->account.seconds[PHASE_TREE] = beyond->tree_block.seconds;
    solver->memory.clusters = beyond->tree->count;
    solver->model.spaces = beyond->spaces;
    solver->model.clusters = cluster_light_create(beyond->tree);
    solver->model.forest->above = alloc_array((size_t)scene_root_count(scene),
                                              sizeof *solver->model.forest->above);
}

/* --- step 3 --- */

/* The part of the work of a node, of 2: its parts of all area, and of all roots. */
static double part_of(const struct solver *solver, int32_t node)
{
    const struct cluster_tree *tree = solver->beyond->tree;
    int32_t roots = 1;
    if (node_is_cluster(node))
        roots = tree->clusters[~node].end - tree->clusters[~node].first;
    return cluster_node_area(tree, solver->model.scene, node) / tree->clusters[0].area +
           (double)roots / tree->root_count;
}

/* Finds the branches of a node, and the clusters above these: a branch has half of
 * a rank's part at most, or is a root. Returns their number; `nodes` has room for all. */
static int32_t find_branches(struct solver *solver, int32_t node, int32_t *nodes)
{
    struct branches *branches = solver->beyond->branches;
    double most = 1.0 / solver->comm->size;
    if (!node_is_cluster(node) || part_of(solver, node) <= most) {
        *nodes = node;
        return 1;
    }
    const struct cluster *cluster = &solver->beyond->tree->clusters[~node];
    int32_t count = 0;
    branches->top[branches->top_count++] = ~node;
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++)
        count += find_branches(solver, cluster->child[k], nodes + count);
    return count;
}

/* Hands homes down from branches, and lists the own clusters. Clusters above the branches
 * are at home on all ranks. */
static void hand_down(struct solver *solver, int *owner)
{
    struct branches *branches = solver->beyond->branches;
    const struct cluster_tree *tree = solver->beyond->tree;
    for (int32_t i = 0; i < tree->count; i++) {
        int home = branches->owner[i];
        if (home == solver->comm->rank)
            branches->own[branches->own_count++] = i;
        for (int k = 0; k < 4 && home >= 0 && tree->clusters[i].child[k] != NODE_NONE;
             k++) {
            int32_t node = tree->clusters[i].child[k];
            *(node_is_cluster(node) ? &branches->owner[~node] : &owner[node]) = home;
        }
    }
    for (int32_t i = 0; i < branches->top_count; i++)
        branches->owner[branches->top[i]] = solver->comm->rank;
}

void above_deal(struct solver *solver, int *owner)
{
    struct branches *branches = solver->beyond->branches;
    size_t clusters = (size_t)solver->beyond->tree->count;
    size_t roots = (size_t)solver->model.forest->root_count;
    branches->owner = alloc_array(clusters, sizeof *branches->owner);
    branches->top = alloc_array(clusters, sizeof *branches->top);
    branches->own = alloc_array(clusters, sizeof *branches->own);
    int32_t *nodes = alloc_array(roots, sizeof *nodes);
    int32_t count = find_branches(solver, NODE_TOP, nodes);
    int64_t *weights = alloc_array((size_t)count, sizeof *weights);
    int *homes = alloc_array((size_t)count, sizeof *homes);
    for (int32_t i = 0; i < count; i++)
        weights[i] = (int64_t)(part_of(solver, nodes[i]) * 0x1p40);
    items_deal(weights, count, solver->comm->size, homes);
    for (size_t i = 0; i < clusters; i++)
        branches->owner[i] = -1;
    for (int32_t i = 0; i < count; i++)
        *(node_is_cluster(nodes[i]) ? &branches->owner[~nodes[i]] : &owner[nodes[i]]) =
            homes[i];
    hand_down(solver, owner);
    solver->above = (struct clusters){branches->owner, solver->model.clusters->radiosity,
                                      solver->model.clusters->flux};
    branches->all = route_to_homes(solver, nodes, count);
    alloc_free(homes);
    alloc_free(weights);
    alloc_free(nodes);
}

/* --- step 5 --- */

static void clear_flux(struct cluster_light *light, const int32_t *clusters,
                       int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        memset(light->flux + BANDS * (int64_t)clusters[i], 0,
               BANDS * sizeof *light->flux);
}

struct rgb *above_begin(struct solver *solver, const struct rgb *vector)
{
    struct cluster_light *light = solver->model.clusters;
    const struct branches *branches = solver->beyond->branches;
    struct rgb *means = NULL;
    account_begin(&solver->account, PHASE_SUMS);
    if (vector != solver->model.forest->radiosity) {
        means = alloc_array((size_t)light->tree->count, sizeof *means);
        cluster_light_average(light, solver->model.forest, vector, means);
        light->sent = means;
    }
    clear_flux(light, branches->top, branches->top_count);
    clear_flux(light, branches->own, branches->own_count);
    account_end(&solver->account, PHASE_SUMS);
    return means;
}

void above_end(struct solver *solver, struct rgb *means)
{
    solver->model.clusters->sent = solver->model.clusters->radiosity;
    alloc_free(means);
}

/* Collective. Sums the flux of the clusters above the branches. */
static void add_top(struct solver *solver)
{
    struct cluster_light *light = solver->model.clusters;
    const struct branches *branches = solver->beyond->branches;
    int64_t count = BANDS * (int64_t)branches->top_count;
    int64_t *flux = alloc_array((size_t)count, sizeof *flux);
    for (int64_t i = 0; i < count; i++)
        flux[i] = light->flux[BANDS * (int64_t)branches->top[i / BANDS] + i % BANDS];
    comm_add(solver->comm, flux, count);
    for (int64_t i = 0; i < count; i++)
        light->flux[BANDS * (int64_t)branches->top[i / BANDS] + i % BANDS] = flux[i];
    if (solver->comm->size > 1)
        solver->account.bytes[CARGO_FLUX] += 2 * count * (int64_t)sizeof *flux;
    alloc_free(flux);
}

void above_collect(struct solver *solver)
{
    struct forest *forest = solver->model.forest;
    struct cluster_light *light = solver->model.clusters;
    const struct branches *branches = solver->beyond->branches;
    account_begin(&solver->account, PHASE_GATHER);
    add_top(solver);
    account_end(&solver->account, PHASE_GATHER);
    account_begin(&solver->account, PHASE_SUMS);
    for (int32_t i = 0; i < branches->top_count; i++)
        cluster_light_push(light, forest, solver->flux, branches->top[i]);
    for (int32_t i = 0; i < branches->own_count; i++)
        cluster_light_push(light, forest, solver->flux, branches->own[i]);
    account_end(&solver->account, PHASE_SUMS);
}

/* --- step 7 --- */

static void average(struct solver *solver, const int32_t *clusters, int32_t count)
{
    struct cluster_light *light = solver->model.clusters;
    const struct forest *forest = solver->model.forest;
    for (int32_t i = count - 1; i >= 0; i--)
        light->radiosity[clusters[i]] = cluster_light_mean(
            light, forest, clusters[i], forest->radiosity, light->radiosity);
}

void above_scatter(struct solver *solver)
{
    const struct branches *branches = solver->beyond->branches;
    account_begin(&solver->account, PHASE_SUMS);
    average(solver, branches->own, branches->own_count);
    account_end(&solver->account, PHASE_SUMS);
    account_begin(&solver->account, PHASE_SCATTER);
    route_share(solver, &branches->all, CARGO_LIGHT);
    account_end(&solver->account, PHASE_SCATTER);
    account_begin(&solver->account, PHASE_SUMS);
    average(solver, branches->top, branches->top_count);
    account_end(&solver->account, PHASE_SUMS);
    solver_renew_proxies(solver);
}
