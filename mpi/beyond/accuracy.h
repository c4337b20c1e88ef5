/* --accuracy: finer links and more rays, round by round. */
#ifndef MPI_BEYOND_ACCURACY_H
#define MPI_BEYOND_ACCURACY_H

#include "mpi/solver.h"

/* Collective. Step 9, and the verdict on its answer. After FINISH_AGAIN criterion and
 * vote are those of the links, for more passes, or for this step again with more
 * rays. */
enum finish accuracy_finish(struct solver *solver, struct vote *vote);

#endif
