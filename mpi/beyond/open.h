/* Roots that may have exact rows in a final gather. */
#ifndef MPI_BEYOND_OPEN_H
#define MPI_BEYOND_OPEN_H

#include "mpi/solver.h"
#include "rad/beyond/gather/gather.h"

/* Collective. Returns 1 for each root proved to have nothing between itself and the roots
 * it faces, else 0: [roots], to be freed. All are 0 if the open ones have less than half
 * of the scene's area. Enters the work into the ledger. */
uint8_t *solver_find_open_roots(struct solver *solver, struct final_gather *gather);

#endif
