/* The tree above the roots, and light over it, on all ranks. All functions are collective. */
#ifndef MPI_BEYOND_ABOVE_H
#define MPI_BEYOND_ABOVE_H

#include "mpi/solver.h"

/* Builds solver->beyond->tree, and what a solver with a tree has besides. */
void above_create(struct solver *solver);
void above_free(struct solver *solver);

/* Step 5: before a transfer, what clusters send; after it, the sums over all ranks of the
 * flux of clusters, pushed down to the roots. */
void above_begin(struct solver *solver);
void above_collect(struct solver *solver);

#endif
