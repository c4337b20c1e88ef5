/* Who does what: pure functions of costs and loads, so that all ranks decide alike, and a
 * simulation of any number of ranks decides as a run would. Cost and work are counted in box and
 * triangle tests; a form factor counts as so many. */
#ifndef MPI_BALANCE_H
#define MPI_BALANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "mpi/plan.h"
#include "rad/link.h"

/* --- single items, whose costs all ranks know --- */

/* Deals items in the given order, each to the rank with the smallest load, of equal ones the
 * lowest. owner[i] is who gets item i; loads grow by what is dealt. */
void items_deal(const int64_t *costs, int64_t count, int64_t *loads, int ranks, int *owner);

/* --- links, of whose costs each rank knows its own --- */

/* What splitting a link is predicted to take: its cost, for the tests of its children are about
 * as many as its own were; and a form factor. Predictions are compared with each other, so
 * factors do not matter. */
int64_t link_load(const struct link *link);

/* What it takes to look at a link: next to nothing where nothing is seen, else so much. */
enum { LOOK_LOAD = 16 };
int64_t link_look_load(const struct link *link);

/* True if what the ranks save takes longer than sending the links. */
bool moving_pays(const int64_t *loads, int ranks);

/* Where the links of `rank` go by a plan (mpi/plan.h): destination[i] is for the link with
 * costs[i]. They are dealt in turn to the receivers of the rank's transfers, a link to a
 * receiver as long as at least half of its cost still fits into what is planned for it; the
 * others, and those that cost nothing, stay. */
void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan, int planned,
                    int rank, int *destination);

/* --- the rows of initial linking --- */

/* A part of what is left of a row after its sample. */
struct row_part {
    int64_t cost; /* predicted */
    int32_t place;
    int part, parts;
};

/* Rows are dealt in stages, each of half of what is left. */
struct row_deal {
    struct row_part *parts; /* [count] stage by stage */
    int *owner;             /* [count] up to `end` */
    int64_t count;
    int64_t first, end;     /* the parts of this stage */
    int64_t all;            /* predicted, of all parts */
    int ranks;
    int64_t *loads;         /* [ranks] what is done, and predicted of what is not known to be done;
                               without the samples, until row_deal_correct() knows of them */
    int64_t *planned;       /* [ranks] predicted, of this stage */
};

/* In how many parts the rest of a row is cut that is expected to take so much. */
int row_parts(int64_t rest);

/* Who samples a row; and whether it goes on with the row at once, while others are sampling. */
int row_sampler(int32_t place, int ranks);
bool row_goes_on(int32_t place, int64_t rest, int ranks);

/* rests[place]: what the rest of each row is expected to take. */
struct row_deal row_deal_start(const int64_t *rests, int32_t rows, int ranks);
void row_deal_end(struct row_deal *deal);

/* Deals the next stage. False if nothing is left. */
bool row_deal_next(struct row_deal *deal);

/* done[r]: what rank r has really done before this stage. */
void row_deal_correct(struct row_deal *deal, const int64_t *done);

#endif
