/* Step 9, phr's own, after the last vote: the final gather. */
#ifndef MPI_BEYOND_STEP9_H
#define MPI_BEYOND_STEP9_H

#include "mpi/solver.h"

/* Collective. Traces rows for all leaves and solves for light by them; from then on
 * `vote` is on this light. FINISH_STOPPED on all ranks if a signal has ended the step.
 * Pre: there are clusters. */
enum finish solver_finish(struct solver *solver, struct vote *vote);

#endif
