/* Step 1 of the paper's Sec. 3.2: broadcasting the scene. */
#ifndef MPI_BROADCAST_H
#define MPI_BROADCAST_H

#include "geom/scene.h"
#include "mpi/comm.h"

/* Collective. `scene` is rank 0's prepared scene, NULL on the others. Returns the scene on
 * every rank (on rank 0 the same). */
struct scene *scene_broadcast(const struct comm *comm, struct scene *scene);

#endif
