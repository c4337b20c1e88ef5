/* Who gets which links before a level of refinement. A dealing is one pure function, so
 * all ranks know what each does, and tests need no MPI. */
#ifndef MPI_BALANCE_H
#define MPI_BALANCE_H

#include <stdint.h>

/* Ranks before dealing. */
struct loads {
    const int64_t *of; /* [ranks] predicted work of the links of each, in tests */
    int ranks;
    int rank;          /* this one */
};

/* Decides where the links of this rank go: destination[i] is the rank to get the link
 * with costs[i], i < count. */
typedef void dealing(struct loads loads, const int64_t *costs, int64_t count,
                     int *destination);

/* The paper's (Sec. 3.3.2, steps 3 and 4): by the greedy plan (mpi/plan.h), to the same
 * predicted work on all ranks. */
dealing deal_greedily;

/* By enum balance (rad/model.h); NULL: no link moves. In mpi/beyond/balance.c. */
extern dealing *const DEALINGS[];

#endif
