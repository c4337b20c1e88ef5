/* Sending links from rank to rank. */
#ifndef MPI_MIGRATE_H
#define MPI_MIGRATE_H

#include "mpi/solver.h"

/* Links sent to other ranks, and received. */
struct traffic {
    int64_t sent, received;
};

enum { BYTES_PER_WIRE_LINK = 32 };

/* Collective. Link i of `list` goes to rank destination[i]; those for this rank stay, in
 * order, in front of arriving ones, in the order of the ranks. Patches of a link that
 * this rank lacks are created. */
struct traffic links_migrate(struct solver *solver, struct link_list *list,
                             const int *destination);

#endif
