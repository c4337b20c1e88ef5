/* The greedy plan of Sec. 3.3.2: how much load goes from which rank to which. A pure
 * function of the loads, so every rank computes the same plan, and none has to be
 * sent. */
#ifndef MPI_PLAN_H
#define MPI_PLAN_H

#include <stdint.h>

struct transfer {
    int from, to;
    int64_t load;
};

/* Plans the transfers to even out `loads` (>= 0) of `ranks` ranks. `transfers` has room
 * for 2 * ranks entries. Returns their number. Afterwards each rank has the mean load, or
 * one unit more on the lowest ranks where the mean is not whole. A rank sends or
 * receives, never both. */
int plan_transfers(const int64_t *loads, int ranks, struct transfer *transfers);

#endif
