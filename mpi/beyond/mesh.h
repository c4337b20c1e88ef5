/* The mesh of a final gather, looked at by all ranks. */
#ifndef MPI_BEYOND_MESH_H
#define MPI_BEYOND_MESH_H

#include "mpi/solver.h"
#include "rad/beyond/gather/mesh.h"

/* Collective. Splits leaves over which light varies, as far as --max-level, --min-area
 * and --memory allow with `links` links, and gives each leaf rays. False if a signal on
 * any rank has ended the work: then the mesh can only be freed. */
bool solver_make_mesh(struct solver *solver, int64_t links, struct gather_mesh *mesh);

#endif
