/* The tree above the roots, on all ranks. */
#ifndef MPI_BEYOND_ABOVE_H
#define MPI_BEYOND_ABOVE_H

#include "mpi/solver.h"

/* Collective. Builds solver->beyond->tree, the same on all ranks, and the light and the
 * arrays of a tree. */
void above_create(struct solver *solver);

/* Step 3 with a tree: homes of roots and of clusters. */
void above_deal(struct solver *solver, int *owner);

/* Step 5, before a transfer: clears the flux of clusters, and averages a vector that is
 * not the light of step 7. Returns these means, for above_end(), after the transfer.
 * Collective, then: sums flux and pushes it down to the own roots. */
struct rgb *above_begin(struct solver *solver, const struct rgb *vector);
void above_end(struct solver *solver, struct rgb *means);
void above_collect(struct solver *solver);

/* Collective. Step 7 with a tree. */
void above_scatter(struct solver *solver);

#endif
