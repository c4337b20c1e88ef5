/* Results of tests on several ranks. */
#ifndef TESTS_RANKS_H
#define TESTS_RANKS_H

#include "mpi/comm.h"

#include "tests/tap.h"

/* Collective. True on all ranks if it is on all of them. */
static inline bool on_all(const struct comm *comm, bool here)
{
    struct error error = {0};
    if (!here)
        error_set(&error, EXIT_FAILED, "rank %d", comm->rank);
    return comm_agree(comm, &error);
}

/* Collective. A test of rank 0 that is passed if it is on all ranks. */
static inline void report(const struct comm *comm, bool here, const char *name)
{
    bool all = on_all(comm, here);
    if (comm->rank == 0)
        tap_ok(all, "%s", name);
}

#endif
