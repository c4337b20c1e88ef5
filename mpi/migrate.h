/* Sending links from rank to rank. */
#ifndef MPI_MIGRATE_H
#define MPI_MIGRATE_H

#include "mpi/solver.h"

/* Collective. Link i of `list` goes to rank destination[i]; those for this rank stay, in order,
 * in front of those that arrive, in the order of the ranks. Patches that a link needs and this
 * rank lacks are created. Returns the bytes sent to other ranks. */
int64_t links_migrate(struct solver *solver, struct link_list *list, const int *destination);

/* Collective. Evens out what load() says of links by the greedy plan; loads[r] is the sum over the links of
 * rank r. Returns the bytes sent to other ranks. */
int64_t links_balance(struct solver *solver, struct link_list *list,
                      int64_t (*load)(const struct link *), const int64_t *loads);

/* Collective. Evens out the numbers of links that carry light, if a rank has more of them
 * than the mean by more than a fiftieth: light is transferred over links where they are.
 * */
void links_even_out(struct solver *solver);

#endif
