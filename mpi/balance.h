/* Who does what: pure functions of costs and loads, so that all ranks decide alike. Cost
 * and work are counted in box and triangle tests; a form factor counts as so many. */
#ifndef MPI_BALANCE_H
#define MPI_BALANCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "mpi/plan.h"
#include "rad/link.h"

/* --- single items, whose costs all ranks know --- */

/* Deals items in the given order, each to the rank with the smallest load, of equal ones the
 * lowest. owner[i] is who gets item i; loads grow by what is dealt. */
void items_deal(const int64_t *costs, int64_t count, int64_t *loads, int ranks, int *owner);

/* --- links, of whose costs each rank knows its own --- */

/* What splitting a link is predicted to take, in tests: its cost, for those of its children are about
 * as many as its own were; and what there is to do besides. */
int64_t link_load(const struct link *link);

/* True if what the ranks save takes longer than sending the links. */
bool moving_pays(const int64_t *loads, int ranks);

/* The work, in tests, after which a rank leaves the rest of a level to be dealt anew, when it has been dealt so
 * often before; INT64_MAX: it leaves none. loads[r]: what rank r has to split. */
int64_t links_limit(const int64_t *loads, int ranks, int stage);

/* Where the links of `rank` go by a plan (mpi/plan.h): destination[i] is for the link with
 * costs[i]. They are dealt in turn to the rank itself and to the receivers of its transfers, for
 * what is wrong in the prediction of one link is likely to be wrong in that of the next: a link to
 * each as long as at least half of its cost still fits into what is planned; the others, and those
 * that cost nothing, stay. */
void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan, int planned,
                    int rank, int *destination);

/* --- the rows of initial linking --- */

/* A part of a row, of its sample or of the rest: roots number `from` to before `to` of it. 24 bytes, no
 * padding. */
struct row_part {
    int64_t cost; /* predicted */
    int32_t place, is_sample;
    int32_t from, to;
};

/* Parts that a row is cut into at most; stopped parts that a rank can tell of at a time, at most; and the work
 * after which the sample of a row is stopped, whatever was expected of it. */
enum { ROW_PARTS_MAX = 64, ROW_NEWS = 64, ROW_SAMPLE_LIMIT = 10000 };

/* What a rank tells all between two stages: the work that it has done and waited for, how many of its
 * parts of the last stage it has begun, and what it has left of those that took too long. No padding. */
struct row_news {
    int64_t clock, begun, count;
    struct row_part left[ROW_NEWS]; /* [count] */
};

/* Bytes of its news that one of so many ranks tells. */
size_t row_news_size(int ranks);

/* Adds what is left of a part. False if there is no room for it, or nobody to be told. */
bool row_news_add(struct row_news *news, const struct row_part *rest, int ranks);

/* Rows are dealt in stages, each of half of what is left. */
struct row_deal {
    struct row_part *parts; /* [count] stage by stage */
    int *owner;             /* [count] up to `end` */
    int64_t count, capacity, owner_capacity;
    int64_t first, end;     /* the parts of this stage */
    int64_t before;         /* the first of the stage before */
    int64_t all;            /* predicted, of all parts at the start */
    int ranks;
    int64_t *loads;         /* [ranks] clocks, as far as they are known, and what is predicted after that */
    int64_t latest;         /* clock of those that have told last */
    int64_t *planned;       /* [ranks] predicted, of this stage */
};

/* Cuts what is expected to take long into equal parts, and what is left of a part into smaller ones.
 * Returns their number. */
int row_cut(const struct row_part *whole, struct row_part parts[ROW_PARTS_MAX]);

/* The work after which a part is stopped, be it of a sample or of the rest. */
int64_t row_limit(const struct row_part *part);

/* What is left of a part that was stopped at root number `stop`, before its end, after so much work. */
struct row_part row_rest(const struct row_part *part, int32_t stop, int64_t work);

/* Who samples which row: owner[place]. costs[place]: what the samples are expected to take. */
void row_deal_samples(const int64_t *costs, int32_t rows, int ranks, int *owner);

/* Whether who samples a row goes on with it at once, while others are sampling. */
bool row_goes_on(int32_t place, int64_t rest);

/* The sample of a row, of `rows`. */
struct row_part row_sample(int32_t rows, int32_t place, int64_t cost);

/* All of a row but for the sample. */
struct row_part row_whole(int32_t rows, int32_t place, int64_t rest);

/* rests[place]: what the rest of each row is expected to take; sampler[place]: who sampled it;
 * sampled[r]: what that took rank r. */
struct row_deal row_deal_start(const int64_t *rests, const int *sampler, int32_t rows,
                               const int64_t *sampled, int ranks);
void row_deal_end(struct row_deal *deal);

/* Deals the next stage, which has no parts if nothing is left to be dealt. A rank begins its parts in their
 * order until it has worked as long as planned. */
void row_deal_next(struct row_deal *deal);

/* True if a rank that has worked so much in this stage, and has this to tell, is not to begin another of its
 * parts. */
bool row_stage_is_over(const struct row_deal *deal, int rank, int64_t worked, const struct row_news *news);

/* A rank's clock when it has heard what all had to tell so far: it has waited for the latest. */
int64_t row_clock(const struct row_deal *deal, int64_t clock);

/* What all ranks had to tell when this stage began, [ranks]. True unless all is known to be done: there
 * are parts to be dealt, or this stage had some. */
bool row_deal_hear(struct row_deal *deal, const struct row_news *news);

#endif
