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

/* True if the cells of the square grid may be where links are best that carry light, `lit` on all ranks
 * together. The same on all ranks. */
bool links_want_cells(const struct solver *solver, int64_t lit);

/* Collective. Links that carry light go where it is best transferred over them: to their cells of the
 * square grid, with --balance cells or where grid_pays() (mpi/balance.h); else ranks that have more of
 * them than the mean send what is above it to those with less, if any is above it by more than a
 * fiftieth. */
void links_place(struct solver *solver);

#endif
