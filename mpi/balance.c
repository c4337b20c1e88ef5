/* Balance.
 *
 * Rows of initial linking. Of each row a sample is linked first (rad/linking.h), rows in turn, and
 * what the rest is expected to take is told to all. Heavy rows are cut, by that alone, so that links
 * do not depend on the ranks. The parts are sorted, heavy ones first, and dealt in stages, each of
 * half of what is left, but for the last: always to the rank with the smallest load. What was wrong
 * in the prediction of one stage is made good in a later one. A stage is dealt with what is known
 * of all but the last, so nobody waits for the news of a stage that somebody still works on; for
 * the same reason, ranks go on with one in eight of their own rows, unless it is heavy, while
 * others are sampling.
 *
 * Rejected: rows in turn, without any prediction (of 32 ranks 13 % idle, of 1,024 80 %: rows differ
 * thirtyfold); all rows in equal parts, one after the other (4 % more work for 8 parts: each begins
 * without shadows, and it takes 64 to be even); a counter from which ranks fetch rows, which
 * needs no prediction, but whose outcome depends on the clock and not on counts.
 *
 * Links. The paper's greedy plan (mpi/plan.h) says how much goes from where to where; what is
 * sent is taken from all of a rank's links in turn. Re-partition along a line of all links was
 * tried: it is as even, for what is left is not the plan's fault but the prediction's: the work
 * of a link is known within a factor of two or so, and a rank has some dozens in a level. */
#include "mpi/balance.h"

#include <stdlib.h>

#include "geom/alloc.h"

/* --- single items --- */

/* A heap of ranks, the smallest load on top. */
struct heap {
    int *ranks; /* [count] */
    int count;
    const int64_t *loads;
};

static bool goes_before(const struct heap *heap, int a, int b)
{
    int64_t x = heap->loads[a], y = heap->loads[b];
    return x != y ? x < y : a < b;
}

static void sink(struct heap *heap, int at)
{
    for (int child = 2 * at + 1; child < heap->count; child = 2 * at + 1) {
        if (child + 1 < heap->count && goes_before(heap, heap->ranks[child + 1], heap->ranks[child]))
            child++;
        int rank = heap->ranks[at], below = heap->ranks[child];
        if (!goes_before(heap, below, rank))
            return;
        heap->ranks[at] = below;
        heap->ranks[child] = rank;
        at = child;
    }
}

void items_deal(const int64_t *costs, int64_t count, int64_t *loads, int ranks, int *owner)
{
    struct heap heap = {.ranks = alloc_array((size_t)ranks, sizeof *heap.ranks), .count = ranks,
                        .loads = loads};
    for (int r = 0; r < ranks; r++)
        heap.ranks[r] = r;
    for (int at = ranks / 2; at >= 0; at--)
        sink(&heap, at);
    for (int64_t i = 0; i < count; i++) {
        owner[i] = heap.ranks[0];
        loads[owner[i]] += costs[i];
        sink(&heap, 0);
    }
    alloc_free(heap.ranks);
}

/* --- links --- */

int64_t link_load(const struct link *link)
{
    return (int64_t)link_cost(link) + TESTS_PER_FORM_FACTOR;
}

int64_t link_look_load(const struct link *link)
{
    return link->seen > 0 ? LOOK_LOAD : 1;
}

/* Tests in the time that a message takes. In an exchange, each rank has one for each other rank. */
enum { TESTS_PER_MESSAGE = 50 };

bool moving_pays(const int64_t *loads, int ranks)
{
    int64_t largest = 0, total = 0;
    for (int r = 0; r < ranks; r++) {
        largest = loads[r] > largest ? loads[r] : largest;
        total += loads[r];
    }
    return largest - total / ranks > (int64_t)TESTS_PER_MESSAGE * (ranks - 1);
}

void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan, int planned,
                    int rank, int *destination)
{
    int mine = 0, turn = 0;
    struct transfer *left = alloc_array((size_t)planned, sizeof *left);
    for (int t = 0; t < planned; t++)
        if (plan[t].from == rank)
            left[mine++] = plan[t];
    for (int64_t i = 0; i < count; i++) {
        destination[i] = rank;
        for (int tried = 0; tried < mine && costs[i] > 0; tried++) {
            struct transfer *t = &left[(turn + tried) % mine];
            if (2 * t->load < costs[i])
                continue;
            destination[i] = t->to;
            t->load -= costs[i];
            turn = (turn + tried + 1) % mine;
            break;
        }
    }
    alloc_free(left);
}

/* --- rows --- */

/* Work of a part, below a millisecond; and parts of a row at most. One row in so many is its
 * sampler's from the start. */
enum { PART_WORK = 25000, PARTS_MAX = 64, GOES_ON = 8 };

int row_parts(int64_t rest)
{
    int64_t parts = 1 + rest / PART_WORK;
    return parts < PARTS_MAX ? (int)parts : PARTS_MAX;
}

int row_sampler(int32_t place, int ranks)
{
    return place % ranks;
}

bool row_goes_on(int32_t place, int64_t rest, int ranks)
{
    return place / ranks % GOES_ON == 0 && row_parts(rest) == 1;
}

static int compare_parts(const void *left, const void *right)
{
    const struct row_part *a = left, *b = right;
    if (a->cost != b->cost)
        return a->cost > b->cost ? -1 : 1;
    if (a->place != b->place)
        return a->place < b->place ? -1 : 1;
    return a->part < b->part ? -1 : 1;
}

struct row_deal row_deal_start(const int64_t *rests, int32_t rows, int ranks)
{
    struct row_deal deal = {.ranks = ranks};
    size_t most = 0;
    for (int32_t place = 0; place < rows; place++)
        most += (size_t)row_parts(rests[place]);
    deal.parts = alloc_array(most, sizeof *deal.parts);
    deal.owner = alloc_array(most, sizeof *deal.owner);
    deal.loads = alloc_array((size_t)ranks, sizeof *deal.loads);
    deal.planned = alloc_array((size_t)ranks, sizeof *deal.planned);
    for (int32_t place = 0; place < rows; place++) {
        int parts = row_parts(rests[place]);
        if (row_goes_on(place, rests[place], ranks)) {
            deal.loads[row_sampler(place, ranks)] += rests[place];
            continue;
        }
        for (int part = 0; part < parts; part++)
            deal.parts[deal.count++] = (struct row_part){
                .cost = 1 + rests[place] / parts, .place = place, .part = part,
                .parts = parts};
    }
    qsort(deal.parts, (size_t)deal.count, sizeof *deal.parts, compare_parts);
    return deal;
}

void row_deal_end(struct row_deal *deal)
{
    alloc_free(deal->parts);
    alloc_free(deal->owner);
    alloc_free(deal->loads);
    alloc_free(deal->planned);
    *deal = (struct row_deal){0};
}

/* The last stage is dealt when no more is left than this part of all. Shorter ones are not worth
 * it: in each, somebody waits for the heaviest part of the one before. */
enum { LAST_SHARE = 32 };

bool row_deal_next(struct row_deal *deal)
{
    int64_t left = 0, taken = 0;
    deal->first = deal->end;
    for (int64_t i = deal->first; i < deal->count; i++)
        left += deal->parts[i].cost;
    deal->all = deal->first == 0 ? left : deal->all;
    bool is_last = left <= deal->all / LAST_SHARE;
    while (deal->end < deal->count && (is_last || 2 * taken < left))
        taken += deal->parts[deal->end++].cost;
    int64_t count = deal->end - deal->first;
    int64_t *costs = alloc_array((size_t)count, sizeof *costs);
    for (int64_t i = 0; i < count; i++)
        costs[i] = deal->parts[deal->first + i].cost;
    for (int r = 0; r < deal->ranks; r++)
        deal->planned[r] = -deal->loads[r];
    items_deal(costs, count, deal->loads, deal->ranks, deal->owner + deal->first);
    for (int r = 0; r < deal->ranks; r++)
        deal->planned[r] += deal->loads[r];
    alloc_free(costs);
    return count > 0;
}

void row_deal_correct(struct row_deal *deal, const int64_t *done)
{
    for (int r = 0; r < deal->ranks; r++)
        deal->loads[r] = done[r] + deal->planned[r];
}
