/* Dealing of roots and links: pure functions of costs and loads, so that all ranks decide
 * alike. Cost and work are counted in box and triangle tests; a form factor counts as
 * TESTS_PER_FORM_FACTOR. */
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

/* Predicted work of splitting a link, in tests: its cost, since the looks at its children
 * take about as much as that at itself, and the form factors. */
int64_t link_load(const struct link *link);

/* True if a level that all ranks have alike is worth dealing, each rank taking its share.
 */
bool level_is_dealt(int64_t links);

/* True if evening out the loads saves more time than sending the links takes. */
bool moving_pays(const int64_t *loads, int ranks);

/* The work, in tests, after which a rank leaves the rest of its links to be dealt anew;
 * INT64_MAX: it leaves none. loads[r]: predicted work of rank r. */
int64_t links_limit(const int64_t *loads, int ranks);

/* Where the links of `rank` go by a plan (mpi/plan.h): destination[i] is for the link
 * with costs[i]. They are dealt in turn to the rank itself and to the receivers of its
 * transfers, since neighbours in the list tend to be predicted wrong alike: a link to
 * each as long as at least half of its cost still fits into the planned load; the others,
 * and links that cost nothing, stay. */
void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan,
                    int planned, int rank, int *destination);

#endif
