/* Step 1: rank 0 reads, all receive.
 *
 * The prepared scene is sent, planes and areas included, and the octree built by rank 0:
 * no rank repeats the work, none could end with other bits, and sending an octree takes
 * less time than building it. Both are packed into one block, of which there is one per
 * node where that pays (mpi/node.c). Ranks of a run share one machine architecture: plain
 * bytes.
 *
 * The memory of rank 0 holds both twice for a moment. A single rank keeps its own. */
#include "mpi/broadcast.h"

static void pack_both(const struct scene *scene, const struct octree *octree,
                      struct pack *pack)
{
    scene_pack(scene, pack);
    if (octree)
        octree_pack(octree, pack);
}

struct node_block scene_broadcast(const struct comm *comm, struct node_policy policy,
                                  struct scene **scene, struct octree **octree)
{
    struct node_block block = {.data = NULL};
    struct octree *built = NULL;
    struct pack count = {0};
    double start = comm_seconds();
    if (comm->rank == 0 && octree)
        built =
            octree_create((*scene)->triangles, scene_blocking_planes(*scene),
                          (*scene)->input_count);
    double seconds = comm_seconds() - start;
    if (comm->size == 1) {
        if (octree)
            *octree = built;
        block.seconds = seconds;
        return block;
    }
    if (comm->rank == 0)
        pack_both(*scene, built, &count);
    comm_broadcast(comm, &count.bytes, sizeof count.bytes);
    node_block_create(&block, comm, count.bytes, policy);
    if (comm->rank == 0) {
        pack_both(*scene, built, &(struct pack){.block = block.data, .writes = true});
        octree_destroy(built);
        scene_destroy(*scene);
    }
    node_block_spread(&block, comm);
    block.seconds = seconds;
    struct pack view = {.block = block.data};
    *scene = scene_view(&view);
    if (octree)
        *octree = octree_view(&view, (*scene)->triangles, (*scene)->planes);
    return block;
}
