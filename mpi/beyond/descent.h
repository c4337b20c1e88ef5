/* Steps 5 and 8 with conjugate residuals. */
#ifndef MPI_BEYOND_DESCENT_H
#define MPI_BEYOND_DESCENT_H

#include "mpi/solver.h"
#include "rad/beyond/total.h"

/* How the ranks of a solver agree on sums of so many terms. */
struct totals totals_of(struct solver *solver, int64_t terms);

/* When links have changed; and after each iteration. */
void descent_begin(struct solver *solver);
struct vote descent_vote(struct solver *solver, const struct ballot *sum);

#endif
