/* The accounts of a rank: seconds by the clock, and work in counts, which do not depend
 * on a noisy machine; and the report of all ranks. */
#ifndef MPI_ACCOUNT_H
#define MPI_ACCOUNT_H

#include "mpi/comm.h"
#include "rad/link.h"
#include "rad/model.h"
#include "rad/stats.h"

/* A phase on one rank, 72 bytes without padding. All ranks have the same, in order. */
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

/* The accounts of this rank, for the report. */
struct account {
    double seconds[PHASE_COUNT];
    int64_t bytes[CARGO_COUNT];    /* to or from other ranks */
    int64_t messages[CARGO_COUNT]; /* as in struct comm_counts */
    int64_t copied;          /* patch records packed or unpacked */
    int64_t recorded[3];     /* of the last three, in the ledger */
    int64_t leaves;          /* at home here, in the last push-pull */
    struct holdings own;     /* of this rank */
    struct ledger ledger;
    struct holdings *each;   /* [ranks] of all, once reported */
};

/* Starts and stops the clock of a phase, which gains the seconds in between. */
void account_begin(struct account *account, enum phase phase);
void account_end(struct account *account, enum phase phase);

/* Enters work done and bytes sent in a phase into the ledger. */
void account_work(struct account *account, enum work kind, int64_t done, int64_t bytes);

/* Collective. Fills in sums and clocks of all ranks as they stand. Borrows the levels. */
void account_report(struct account *account, const struct comm *comm,
                    const struct model *model, const struct link_list *links,
                    struct stats *stats);
void account_free(struct account *account);

#endif
