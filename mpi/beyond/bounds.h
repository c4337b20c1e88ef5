/* Bounds on the light of the ends of links, for refinement by error. */
#ifndef MPI_BEYOND_BOUNDS_H
#define MPI_BEYOND_BOUNDS_H

#include "mpi/solver.h"

/* Collective. Step 4, before a pass, and before each of its levels. */
void bounds_prepare(struct solver *solver);
void bounds_learn(struct solver *solver, const struct route *originals,
                  const struct route *proxies);

#endif
