/* The work of each rank, phase by phase, in counts, which do not depend on a noisy
 * machine. */
#ifndef MPI_LEDGER_H
#define MPI_LEDGER_H

#include "mpi/comm.h"
#include "rad/stats.h"

/* A phase on one rank; 72 bytes, no padding. All ranks have the same phases in the same
 * order. */
struct phase_work {
    int32_t kind;             /* enum work */
    int32_t level;            /* of refinement, or 0 */
    int64_t pass;             /* of refinement, or 0 */
    struct level_share share; /* `done`: its work; the rest is of refinement, linking */
    int64_t bytes;            /* sent by the rank for the phase */
};

struct ledger {
    struct phase_work *items; /* [count] phases not known to all ranks yet */
    int64_t count, capacity;
    struct work_sums sums[WORK_COUNT]; /* of phases known to all ranks */
    struct level_balance *levels;      /* [level_count] linking and refinement */
    int64_t level_count, level_capacity;
};

void ledger_add(struct ledger *ledger, struct phase_work phase);

/* Collective. All ranks learn the sums and maxima of phases added since the last call. */
void ledger_share(struct ledger *ledger, const struct comm *comm);

void ledger_free(struct ledger *ledger);

#endif
