/* Who does what: pure functions of costs and loads, so that all ranks decide alike. Cost
 * and work are counted in box and triangle tests; a form factor counts as so many. */
#ifndef MPI_BALANCE_H
#define MPI_BALANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "mpi/plan.h"
#include "rad/beyond/node_link.h"

/* --- single items, whose costs all ranks know --- */

/* Deals items in the given order, each to the rank with the smallest load, of equal ones
 * the lowest. owner[i] is who gets item i; loads grow by what is dealt. */
void items_deal(const int64_t *costs, int64_t count, int64_t *loads, int ranks,
                int *owner);

/* --- links, of whose costs each rank knows its own --- */

/* What splitting a link is predicted to take, in tests: its cost, for those of its
 * children are about as many as its own were; and what there is to do besides. */
int64_t link_load(const struct link *link);

/* True if a level that all ranks have alike is worth dealing, each rank taking its share.
 */
bool level_is_dealt(int64_t links);

/* True if what the ranks save takes longer than sending the links. */
bool moving_pays(const int64_t *loads, int ranks);

/* The work, in tests, after which a rank leaves the rest of its links to be dealt anew;
 * INT64_MAX: it leaves none. loads[r]: predicted work of rank r. */
int64_t links_limit(const int64_t *loads, int ranks);

/* Where the links of `rank` go by a plan (mpi/plan.h): destination[i] is for the link
 * with costs[i]. They are dealt in turn to the rank itself and to the receivers of its
 * transfers, for what is wrong in the prediction of one link is likely to be wrong in
 * that of the next: a link to each as long as at least half of its cost still fits into
 * what is planned; the others, and those that cost nothing, stay. */
void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan,
                    int planned, int rank, int *destination);

#endif
