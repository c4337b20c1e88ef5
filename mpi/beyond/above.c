/* The tree above the roots on all ranks: built by rank 0, sent like the octree
 * (mpi/broadcast.c). Clusters have no home: each rank gets the sums of their flux. */
#include "mpi/beyond/beyond.h"

#include <string.h>

#include "geom/alloc.h"

/* --- building --- */

static int32_t *places_gather(const struct comm *comm, const struct scene *scene,
                              const struct octree *octree)
{
    int64_t all = scene_root_count(scene);
    int32_t first = (int32_t)(all * comm->rank / comm->size);
    int32_t end = (int32_t)(all * (comm->rank + 1) / comm->size);
    int32_t *own = places_met(scene, octree, first, end);
    int *at = alloc_array((size_t)comm->size + 1, sizeof *at);
    int64_t bytes = SPACE_RAYS * (int64_t)(end - first) * (int64_t)sizeof *own;
    void *met = comm_gather_all(comm, own, bytes, at);
    alloc_free(at);
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
    double start = comm_seconds();
    int32_t *met = solver->model.octree ? places_gather(comm, scene, solver->model.octree)
                                        : NULL;
    beyond->spaces = spaces_create(scene, met);
    alloc_free(met);
    solver->account.seconds[PHASE_SPACES] = comm_seconds() - start;
    beyond->tree_block =
        tree_broadcast(comm, node_policy(), scene, beyond->spaces, &beyond->tree);
    solver->account.seconds[PHASE_TREE] = beyond->tree_block.seconds;
    solver->memory.clusters = beyond->tree->count;
    solver->model.spaces = beyond->spaces;
    solver->model.clusters = cluster_light_create(beyond->tree);
    solver->model.forest->above = alloc_array((size_t)scene_root_count(scene),
                                              sizeof *solver->model.forest->above);
}

void above_free(struct solver *solver)
{
    cluster_light_destroy(solver->model.clusters);
    cluster_tree_destroy(solver->beyond->tree);
    spaces_destroy(solver->beyond->spaces);
    node_block_destroy(&solver->beyond->tree_block);
}

/* --- step 5 --- */

void above_begin(struct solver *solver, const struct rgb *vector)
{
    struct cluster_light *clusters = solver->model.clusters;
    double start = comm_seconds();
    cluster_light_average(clusters, solver->model.forest, vector, clusters->sent);
    memset(clusters->flux, 0,
           BANDS * (size_t)clusters->tree->count * sizeof *clusters->flux);
    solver->account.seconds[PHASE_SUMS] += comm_seconds() - start;
}

void above_collect(struct solver *solver)
{
    double start = comm_seconds();
    struct cluster_light *clusters = solver->model.clusters;
    int64_t count = BANDS * (int64_t)solver->beyond->tree->count;
    comm_add(solver->comm, clusters->flux, count);
    if (solver->comm->size > 1)
        solver->account.bytes[CARGO_FLUX] += 2 * count * (int64_t)sizeof *clusters->flux;
    double come = comm_seconds();
    cluster_light_push(clusters, solver->model.forest, solver->flux);
    solver->account.seconds[PHASE_GATHER] += come - start;
    solver->account.seconds[PHASE_SUMS] += comm_seconds() - come;
}
