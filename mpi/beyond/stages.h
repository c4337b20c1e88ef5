/* Looks and rows of the final gather, dealt to ranks in stages. */
#ifndef MPI_BEYOND_STAGES_H
#define MPI_BEYOND_STAGES_H

#include "mpi/solver.h"
#include "rad/beyond/gather/gather.h"

struct stages {
    struct solver *solver;
    const struct final_gather *gather; /* counts the work done */
    void (*act)(void *context, int64_t item);
    void *context;
    const int64_t *work; /* [count] predicted for each item, in any unit, at least 1 */
    int64_t count;
    int *counts;       /* [ranks] items done by a rank */
    int *at;           /* [ranks] place of a rank's first item */
    int32_t *place;    /* [count] of each item: rank by rank, in the order of work */
    int *rank_of;      /* [count] rank that does an item */
    int32_t *items;    /* [left] not done yet, heavy ones first */
    int64_t left;
    double all, done;  /* work predicted for all items, and for those done, about */
    double ratio;      /* tests that items took for the work predicted, in a stage */
};

/* Collective. Has each item done on one rank, with about the same work for all ranks.
 * Pre: the fields up to `count` are set, the others 0. After a signal, items left count
 * as done. */
void stages_run(struct stages *stages);
void stages_free(struct stages *stages);

#endif
