/* Records from all ranks to rank 0, which takes single records from the rank of its
 * choice, with no more than a piece of each other rank's in memory. */
#ifndef MPI_BEYOND_FUNNEL_H
#define MPI_BEYOND_FUNNEL_H

#include "mpi/comm.h"

/* What comes from one rank. */
struct spout {
    const char *records; /* this rank's own, or the piece at hand */
    char *piece;         /* owned; NULL for this rank's own */
    int64_t at, count;   /* next record of the piece, and their number */
    int64_t left;        /* records still with their rank */
};

struct funnel {
    const struct comm *comm; /* borrowed */
    size_t bytes;            /* of a record */
    struct spout *spouts;    /* [ranks], owned; NULL but on rank 0 */
};

/* Collective. `count` records of `bytes` bytes without padding on each rank; rank 0
 * borrows its own until the end. Other ranks return when theirs have been taken. */
void funnel_start(struct funnel *funnel, const struct comm *comm, const void *records,
                  int64_t count, size_t bytes);

/* Rank 0 only: the next record of a rank, in the rank's order, or NULL after the last.
 * Good until the next call for the rank; spouts[rank].at++ goes past the record. */
const void *funnel_next(struct funnel *funnel, int rank);

/* Rank 0 has taken all records. */
void funnel_end(struct funnel *funnel);

#endif
