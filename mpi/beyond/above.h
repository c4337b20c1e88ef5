/* The tree above the roots, and light over it, on all ranks. All functions are
 * collective. */
#ifndef MPI_BEYOND_ABOVE_H
#define MPI_BEYOND_ABOVE_H

#include "mpi/solver.h"

/* Builds solver->beyond->tree, and the light and the arrays that a tree needs. */
void above_create(struct solver *solver);
void above_free(struct solver *solver);

/* Step 5, before a transfer: computes the radiosity of clusters, and clears their
 * flux. */
void above_begin(struct solver *solver, const struct rgb *vector);

/* Step 5, after a transfer: sums the flux of clusters over all ranks and pushes it down
 * to the roots. */
void above_collect(struct solver *solver);

#endif
