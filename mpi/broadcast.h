/* Step 1 of the paper's Sec. 3.2: broadcasting the scene, and with it the octree and the
 * tree above the roots. */
#ifndef MPI_BROADCAST_H
#define MPI_BROADCAST_H

#include "geom/scene.h"
#include "mpi/node.h"
#include "octree/octree.h"
#include "rad/beyond/cluster.h"

/* Collective. `*scene` is rank 0's prepared scene, NULL on the others, and becomes the scene on every
 * rank; `*octree`, unless NULL is given for it, becomes the octree over it. Both look into the block that
 * is returned, which is to be destroyed after them. */
struct node_block scene_broadcast(const struct comm *comm, struct node_policy policy,
                                  struct scene **scene, struct octree **octree);

/* Collective. Where rays from all roots end, as places_met() has it, on all ranks; each
 * traces its share. */
int32_t *places_gather(const struct comm *comm, const struct scene *scene,
                       const struct octree *octree);

/* Collective. Rank 0 builds the tree above the roots of the scene, which all have, from
 * the places met (NULL: none); all get the tree, in a block as above. */
struct node_block tree_broadcast(const struct comm *comm, struct node_policy policy,
                                 const struct scene *scene, const int32_t *met,
                                 struct cluster_tree **tree);

#endif
