/* Sending links from rank to rank. */
#ifndef MPI_MIGRATE_H
#define MPI_MIGRATE_H

#include "mpi/solver.h"

/* Collective. Link i of `list` goes to rank destination[i]; those for this rank stay, in order,
 * in front of those that arrive, in the order of the ranks. Patches that a link needs and this
 * rank lacks are created. Returns the bytes sent to other ranks. */
int64_t links_migrate(struct solver *solver, struct link_list *list, const int *destination);

#endif
