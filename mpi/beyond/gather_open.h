/* Roots whose leaves may have exact rows in a final gather. */
#ifndef MPI_BEYOND_GATHER_OPEN_H
#define MPI_BEYOND_GATHER_OPEN_H

#include "mpi/solver.h"
#include "rad/beyond/gather/gather.h"

/* Collective. Returns 1 for each root of which it is proved that nothing stands between
 * it and the roots that it faces, else 0: [roots], to be freed. All are 0 if the open
 * ones have less than half of the scene's area. The work goes into the solver's
 * ledger. */
uint8_t *gather_find_open_roots(struct solver *solver, struct final_gather *gather);

#endif
