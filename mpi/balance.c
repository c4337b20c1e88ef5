/* Balance.
 *
 * Rows of initial linking. Of each row a sample is linked first (rad/linking.h), samples being
 * dealt by the sizes of the roots, and what the rest is expected to take is told to all. Heavy
 * rows are cut, by that alone, so that links do not depend on the ranks. The parts are sorted,
 * heavy ones first, and dealt in stages, each of half of what is left, but for the last: always
 * to the rank with the smallest load. What was wrong in the prediction of one stage is made good
 * in a later one: a rank begins parts until it has worked as long as planned, and those that it
 * has not begun are dealt anew. So is what is left of a part, or of a sample, that takes much
 * longer than predicted: it is stopped, by its work alone again, and cut. A stage is dealt with
 * what is known of all but the last, so nobody waits for the news of a stage that somebody still
 * works on; for the same reason, ranks go on with one in eight of their own rows, unless it is
 * heavy, while others are sampling. What ranks wait for all the same is part of their load, or
 * in the end those would get most that have worked least, and all would wait for them.
 *
 * In a room of 31,933 triangles on 1,024 ranks, replayed, 12 % of this are idle; 39 % were when
 * parts were not stopped and waits were no load.
 *
 * Rejected: rows in turn, without any prediction (of 32 ranks 13 % idle, of 1,024 80 %: rows differ
 * thirtyfold); all rows in equal parts, one after the other (4 % more work for 8 parts: each begins
 * without shadows, and it takes 64 to be even); a counter from which ranks fetch rows, which
 * needs no prediction, but whose outcome depends on the clock and not on counts.
 *
 * Links. The paper's greedy plan (mpi/plan.h) says how much goes from where to where; what is
 * sent is taken from all of a rank's links in turn. Re-partition along a line of all links was
 * tried: it is as even, for what is left is not the plan's fault but the prediction's: the work
 * of a link is known within a factor of two or so. So a level with much to do is split in
 * stages: a rank stops before it has worked as long as predicted of the mean rank, and the
 * rest is dealt anew. In a room of 6,350 triangles on 32 ranks (--stats, "splitting") 7 %
 * of refinement are idle; 16 % are where levels are dealt once (--balance greedy). To go on
 * with the next level meanwhile is a little better still, but then what fits into memory
 * would depend on the number of ranks. */
#include "mpi/balance.h"

#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "rad/linking.h"

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

/* What four form factors take where the way is open, for then it is for the children; and beside the
 * tests where it is not, for however few there were, four times 16 segments have to be followed. (In
 * furnished rooms a link takes 60 to 110 tests more than its cost says, in the Cornell box 30. With
 * one form factor in place of that a third more of a level was idle.) */
enum { LOAD_OPEN = 4 * TESTS_PER_FORM_FACTOR, LOAD_LEAST = 80 };

int64_t link_load(const struct link *link)
{
    return link_is_open(link) ? LOAD_OPEN : LOAD_LEAST + (int64_t)link_cost(link);
}

/* Tests in the time that a message takes. Ranks tell each other how many links come in log P messages,
 * and few have more than so many others to send to or to receive from. */
enum { TESTS_PER_MESSAGE = 50, PARTNERS = 4 };

bool moving_pays(const int64_t *loads, int ranks)
{
    int64_t largest = 0, total = 0;
    for (int r = 0; r < ranks; r++) {
        largest = loads[r] > largest ? loads[r] : largest;
        total += loads[r];
    }
    int messages = PARTNERS;
    for (int reached = 1; reached < ranks; reached *= 2)
        messages++;
    return largest - total / ranks > TESTS_PER_MESSAGE * messages;
}

/* A stage takes so much of what is predicted of the mean rank: unless that was by far too much, hardly any rank is
 * done before it ends. The last of three takes what is left, and so does one of less than so many tests, which
 * is not worth a new deal. */
static const double STAGE_SHARE = 0.7;
enum { STAGES = 3, STAGE_LEAST = 3000 };

int64_t links_limit(const int64_t *loads, int ranks, int stage)
{
    int64_t mean = 0;
    for (int r = 0; r < ranks; r++)
        mean += loads[r] / ranks;
    bool last = ranks == 1 || stage == STAGES - 1 || mean < STAGE_LEAST;
    return last ? INT64_MAX : (int64_t)(STAGE_SHARE * (double)mean);
}

void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan, int planned,
                    int rank, int *destination)
{
    int mine = 1, turn = 0;
    struct transfer *left = alloc_array((size_t)planned + 1, sizeof *left);
    left[0] = (struct transfer){rank, rank, 0};
    for (int64_t i = 0; i < count; i++)
        left[0].load += costs[i];
    for (int t = 0; t < planned; t++)
        if (plan[t].from == rank) {
            left[mine++] = plan[t];
            left[0].load -= plan[t].load;
        }
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

/* Work of a part, below a millisecond; of what is left of one, of which there are few, but late, and
 * what it takes is foretold badly; what a part may take beyond half more than predicted; and how much more
 * than planned a rank works in a stage, so that nothing small is given back. One row in so many is its
 * sampler's from the start. */
enum { PART_WORK = 25000, LEFT_WORK = 300, LIMIT_MORE = 2000, STAGE_MORE = 1000, GOES_ON = 8 };

int row_cut(const struct row_part *whole, struct row_part parts[ROW_PARTS_MAX])
{
    int64_t length = whole->to - whole->from;
    bool is_left = whole->is_sample || whole->from > 0;
    int64_t count = 1 + whole->cost / (is_left ? LEFT_WORK : PART_WORK);
    count = count < ROW_PARTS_MAX ? count : ROW_PARTS_MAX;
    count = count < length ? count : length;
    for (int64_t i = 0; i < count; i++)
        parts[i] = (struct row_part){.cost = 1 + whole->cost / count,
                                     .place = whole->place, .is_sample = whole->is_sample,
                                     .from = whole->from + (int32_t)(length * i / count),
                                     .to = whole->from + (int32_t)(length * (i + 1) / count)};
    return (int)count;
}

/* Half more than predicted, and somewhat more. */
int64_t row_limit(const struct row_part *part)
{
    return part->cost + part->cost / 2 + LIMIT_MORE;
}

/* Where ranks are few, each stops more parts in a stage. Together they tell of a thousand at most, or of 16 each;
 * then a rank's stage is over, so that it does not link the rest of hundreds of parts alone. */
static int news_room(int ranks)
{
    int room = 1024 / ranks;
    return room > ROW_NEWS ? ROW_NEWS : room < 16 ? 16 : room;
}

size_t row_news_size(int ranks)
{
    return offsetof(struct row_news, left) + (size_t)news_room(ranks) * sizeof(struct row_part);
}

bool row_news_add(struct row_news *news, const struct row_part *rest, int ranks)
{
    if (ranks == 1 || news->count == news_room(ranks))
        return false;
    news->left[news->count++] = *rest;
    return true;
}

/* Of what was expected per root, and of what was found, the mean by their numbers of roots. */
struct row_part row_rest(const struct row_part *part, int32_t stop, int64_t work)
{
    double roots = (double)(part->to - part->from) + (double)(stop - part->from);
    double each = (double)(part->cost + work) / roots;
    return (struct row_part){.cost = (int64_t)(each * (double)(part->to - stop)),
                             .place = part->place, .is_sample = part->is_sample,
                             .from = stop, .to = part->to};
}

/* Those that take several times the mean first, each of which may be more than a rank's share of
 * the rest. */
void row_deal_samples(const int64_t *costs, int32_t rows, int ranks, int *owner)
{
    int64_t *sorted = alloc_array((size_t)rows, sizeof *sorted);
    int64_t *loads = alloc_array((size_t)ranks, sizeof *loads), sum = 0;
    int32_t *places = alloc_array((size_t)rows, sizeof *places), count = 0;
    int *owners = alloc_array((size_t)rows, sizeof *owners);
    for (int32_t place = 0; place < rows; place++)
        sum += costs[place];
    for (int heavy = 1; heavy >= 0; heavy--)
        for (int32_t place = 0; place < rows; place++)
            if ((costs[place] > 4 * (sum / rows)) == heavy) {
                sorted[count] = costs[place];
                places[count++] = place;
            }
    items_deal(sorted, rows, loads, ranks, owners);
    for (int32_t i = 0; i < rows; i++)
        owner[places[i]] = owners[i];
    alloc_free(owners);
    alloc_free(places);
    alloc_free(loads);
    alloc_free(sorted);
}

/* Which rows, must have nothing to do with how samples are dealt, in turn where they are alike. */
bool row_goes_on(int32_t place, int64_t rest)
{
    return (uint32_t)place * UINT32_C(2654435769) / (UINT32_MAX / GOES_ON + 1) == 0 && rest < PART_WORK;
}

struct row_part row_sample(int32_t rows, int32_t place, int64_t cost)
{
    struct row_part sample = row_whole(rows, place, cost);
    sample.is_sample = true;
    return sample;
}

struct row_part row_whole(int32_t rows, int32_t place, int64_t rest)
{
    return (struct row_part){.cost = rest, .place = place, .from = 0,
                             .to = linking_row_length(rows, place)};
}

int64_t row_clock(const struct row_deal *deal, int64_t clock)
{
    return clock > deal->latest ? clock : deal->latest;
}

bool row_stage_is_over(const struct row_deal *deal, int rank, int64_t worked, const struct row_news *news)
{
    bool is_full = news->count == news_room(deal->ranks);
    return deal->ranks > 1 && (worked >= deal->planned[rank] + STAGE_MORE || is_full);
}

static int compare_parts(const void *left, const void *right)
{
    const struct row_part *a = left, *b = right;
    if (a->cost != b->cost)
        return a->cost > b->cost ? -1 : 1;
    if (a->place != b->place)
        return a->place < b->place ? -1 : 1;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return a->is_sample - b->is_sample;
}

/* Parts to be dealt; to be sorted before they are. */
static void add_parts(struct row_deal *deal, const struct row_part *whole)
{
    deal->parts = alloc_reserve(deal->parts, &deal->capacity, deal->count + ROW_PARTS_MAX,
                                sizeof *deal->parts);
    deal->count += row_cut(whole, deal->parts + deal->count);
}

static void sort_parts(struct row_deal *deal)
{
    if (deal->count > deal->end)
        qsort(deal->parts + deal->end, (size_t)(deal->count - deal->end), sizeof *deal->parts,
              compare_parts);
}

struct row_deal row_deal_start(const int64_t *rests, const int *sampler, int32_t rows,
                               const int64_t *sampled, int ranks)
{
    struct row_deal deal = {.ranks = ranks};
    deal.loads = alloc_array((size_t)ranks, sizeof *deal.loads);
    deal.planned = alloc_array((size_t)ranks, sizeof *deal.planned);
    for (int r = 0; r < ranks; r++)
        deal.latest = deal.latest > sampled[r] ? deal.latest : sampled[r];
    memcpy(deal.loads, sampled, (size_t)ranks * sizeof *sampled);
    for (int32_t place = 0; place < rows; place++) {
        struct row_part whole = row_whole(rows, place, rests[place]);
        if (row_goes_on(place, rests[place]))
            deal.loads[sampler[place]] += rests[place];
        else
            add_parts(&deal, &whole);
    }
    for (int64_t i = 0; i < deal.count; i++)
        deal.all += deal.parts[i].cost;
    for (int r = 0; r < ranks; r++)
        deal.loads[r] = row_clock(&deal, deal.loads[r]);
    sort_parts(&deal);
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

/* All is dealt at once when no more is left than this part of all. Shorter stages are not worth
 * it: in each, somebody waits for the heaviest part of the one before. */
enum { LAST_SHARE = 32 };

void row_deal_next(struct row_deal *deal)
{
    int64_t left = 0, taken = 0;
    deal->before = deal->first;
    deal->first = deal->end;
    for (int64_t i = deal->first; i < deal->count; i++)
        left += deal->parts[i].cost;
    bool is_last = left <= deal->all / LAST_SHARE;
    while (deal->end < deal->count && (is_last || 2 * taken < left))
        taken += deal->parts[deal->end++].cost;
    int64_t count = deal->end - deal->first;
    int64_t *costs = alloc_array((size_t)count, sizeof *costs);
    for (int64_t i = 0; i < count; i++)
        costs[i] = deal->parts[deal->first + i].cost;
    for (int r = 0; r < deal->ranks; r++)
        deal->planned[r] = -deal->loads[r];
    deal->owner = alloc_reserve(deal->owner, &deal->owner_capacity, deal->end, sizeof *deal->owner);
    items_deal(costs, count, deal->loads, deal->ranks, deal->owner + deal->first);
    for (int r = 0; r < deal->ranks; r++)
        deal->planned[r] += deal->loads[r];
    alloc_free(costs);
}

bool row_deal_hear(struct row_deal *deal, const struct row_news *news)
{
    int64_t known = deal->count;
    int64_t *begun = alloc_array((size_t)deal->ranks, sizeof *begun);
    for (int64_t i = deal->before; i < deal->first; i++) {
        struct row_part part = deal->parts[i];
        if (begun[deal->owner[i]]++ < news[deal->owner[i]].begun)
            continue;
        deal->parts = alloc_reserve(deal->parts, &deal->capacity, deal->count + 1,
                                    sizeof *deal->parts);
        deal->parts[deal->count++] = part;
    }
    for (int r = 0; r < deal->ranks; r++)
        deal->latest = deal->latest > news[r].clock ? deal->latest : news[r].clock;
    for (int r = 0; r < deal->ranks; r++) {
        deal->loads[r] = row_clock(deal, news[r].clock + deal->planned[r]);
        for (int64_t i = 0; i < news[r].count; i++)
            add_parts(deal, &news[r].left[i]);
    }
    if (deal->count > known)
        sort_parts(deal);
    alloc_free(begun);
    return deal->end < deal->count || deal->first < deal->end;
}
