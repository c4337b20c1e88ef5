/* What each rank has done, phase by phase: work in counts, for they do not depend on a noisy machine. */
#ifndef MPI_LEDGER_H
#define MPI_LEDGER_H

#include "mpi/comm.h"
#include "rad/stats.h"

/* One phase on one rank, or a stage of one. All ranks have the same in the same order. */
struct phase_work {
    enum work kind;
    int64_t iteration, level; /* as in struct level_balance */
    int64_t links, predicted, work;
    int64_t bytes;            /* that it sent for it */
};

struct ledger {
    struct phase_work *items; /* [count] not yet known to all ranks */
    int64_t count, capacity;
    struct work_sums sums[WORK_COUNT]; /* of what is known, the same on all ranks */
    struct level_balance *levels;      /* [level_count] linking and levels of refinement: the same */
    int64_t level_count, level_capacity;
};

void ledger_add(struct ledger *ledger, struct phase_work phase);

/* Collective. All ranks learn the sums and maxima of what was added since. */
void ledger_share(struct ledger *ledger, const struct comm *comm);

void ledger_free(struct ledger *ledger);

#endif
