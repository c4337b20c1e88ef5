/* Step 1 of the paper's Sec. 3.2: broadcasting the scene with the octree. */
#ifndef MPI_BROADCAST_H
#define MPI_BROADCAST_H

#include "geom/scene.h"
#include "mpi/node.h"
#include "octree/octree.h"

/* Collective. `*scene` is rank 0's prepared scene, NULL on the others, and becomes the
 * scene on every rank; `*octree`, unless NULL is given, becomes the octree over the
 * scene. Both look into the returned block, which is to be destroyed last. */
struct node_block scene_broadcast(const struct comm *comm, struct node_policy policy,
                                  struct scene **scene, struct octree **octree);

#endif
