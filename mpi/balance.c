/* Balance.
 *
 * The paper's greedy plan (mpi/plan.h) says how much load goes from which rank to which;
 * links are taken from all of a rank's links in turn. The work of a link is predicted
 * within a factor of two or so. So links are split in stages: each rank stops at the same
 * amount of work, less than is predicted of the mean rank, and the rest is dealt anew.
 * Then the grain remains, the last link of a rank in each stage, so stages should be few.
 * That is why they do not end with a level (mpi/refinement.c): in a room of 999,960
 * triangles on 32 ranks the slowest rank has 1.07 of the mean work, with stages that do
 * 1.24 (make scaling ROOM=1000000).
 *
 * Rejected: re-partition along a line of all links, which is as even as the plan is. */
#include "mpi/balance.h"

#include "geom/alloc.h"
#include "rad/beyond/cluster.h"

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
        if (child + 1 < heap->count &&
            goes_before(heap, heap->ranks[child + 1], heap->ranks[child]))
            child++;
        int rank = heap->ranks[at], below = heap->ranks[child];
        if (!goes_before(heap, below, rank))
            return;
        heap->ranks[at] = below;
        heap->ranks[child] = rank;
        at = child;
    }
}

void items_deal(const int64_t *costs, int64_t count, int64_t *loads, int ranks,
                int *owner)
{
    struct heap heap = {.ranks = alloc_array((size_t)ranks, sizeof *heap.ranks),
                        .count = ranks,
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

/* Tests for the children of two patches. Those of an open link are open, and take four
 * form factors. Else four times 16 segments are followed: that takes as many tests as the
 * cost of the link, and some more. (In furnished rooms 60 to 110 more, in the Cornell box
 * 30. With one form factor in place of that a third more of a level was idle.) */
enum { LOAD_OPEN = 4 * TESTS_PER_FORM_FACTOR, LOAD_LEAST = 80 };

/* With a cluster in it: for each child a look, and a second one where it is not to be
 * split. The cost is unknown of a link that nobody has looked at (cost 1); the link of a
 * cluster with itself has up to ten children. */
enum { LOAD_CLUSTER = 300, LOAD_CLUSTER_UNSEEN = 1000, LOAD_CLUSTER_ITSELF = 4000 };
enum { LOOKS_PER_CLUSTER = 4 };

static int64_t cluster_load(const struct link *link)
{
    if (link->p == link->q)
        return LOAD_CLUSTER_ITSELF;
    int64_t cost = (int64_t)link_cost(link);
    return cost > 1 ? LOAD_CLUSTER + LOOKS_PER_CLUSTER * cost : LOAD_CLUSTER_UNSEEN;
}

int64_t link_load(const struct link *link)
{
    if (node_is_cluster(link->p) || node_is_cluster(link->q))
        return cluster_load(link);
    return link_is_open(link) ? LOAD_OPEN : LOAD_LEAST + (int64_t)link_cost(link);
}

/* This many links take longer than the messages of a level, on any number of ranks. */
enum { LINKS_TO_DEAL = 16 };

bool level_is_dealt(int64_t links)
{
    return links >= LINKS_TO_DEAL;
}

/* Tests in the time of a message. Ranks tell each other the numbers of links in log P
 * messages, and few of them exchange links with more than four others. */
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

/* A stage takes a part of the predicted work of the mean rank: unless the prediction is
 * much too high, hardly any rank runs out of links before the others. It takes no less
 * than a few links do, in tests: less is not worth a new deal. */
static const double STAGE_SHARE = 0.8;
enum { STAGE_LEAST = 4000 };

int64_t links_limit(const int64_t *loads, int ranks)
{
    int64_t mean = 0;
    for (int r = 0; r < ranks; r++)
        mean += loads[r] / ranks;
    int64_t limit = (int64_t)(STAGE_SHARE * (double)mean);
    return ranks == 1 ? INT64_MAX : limit < STAGE_LEAST ? STAGE_LEAST : limit;
}

void links_deal_out(const int64_t *costs, int64_t count, const struct transfer *plan,
                    int planned, int rank, int *destination)
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
