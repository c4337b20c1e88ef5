/* A solver for any criterion. */
#ifndef MPI_BEYOND_CREATE_H
#define MPI_BEYOND_CREATE_H

#include "mpi/beyond/beyond.h"

/* Collective. Borrows comm, scene and octree. */
struct solver *beyond_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion);

#endif
