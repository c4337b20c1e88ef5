/* Balance: every item and link has one owner, the same whoever asks; loads end as even as
 * the costs allow, for up to 1,024 ranks, empty and equal loads too. */
#include "mpi/balance.h"

#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

static int64_t largest_of(const int64_t *values, int count)
{
    int64_t largest = 0;
    for (int i = 0; i < count; i++)
        largest = values[i] > largest ? values[i] : largest;
    return largest;
}

static int64_t sum_of(const int64_t *values, int count)
{
    int64_t sum = 0;
    for (int i = 0; i < count; i++)
        sum += values[i];
    return sum;
}

/* --- items --- */

/* No rank may be above the mean, or above where it began, by more than the largest item. */
static void test_items(int ranks, int count)
{
    struct random random = random_seed(5 + (uint64_t)ranks);
    int64_t *costs = alloc_array((size_t)count, sizeof *costs);
    int64_t *loads = alloc_array(3 * (size_t)ranks, sizeof *loads);
    int64_t *expected = loads + ranks, *start = expected + ranks;
    int *owner = alloc_array((size_t)count, sizeof *owner);
    bool right = true;
    for (int r = 0; r < ranks; r++)
        start[r] = loads[r] = expected[r] = (int64_t)(random_bits(&random) % 100);
    for (int i = 0; i < count; i++)
        costs[i] = (int64_t)(random_bits(&random) % 1000);
    items_deal(costs, count, loads, ranks, owner);
    for (int i = 0; i < count; i++) {
        int least = 0;
        for (int r = 1; r < ranks; r++)
            least = expected[r] < expected[least] ? r : least;
        right = right && owner[i] == least;
        expected[least] += costs[i];
    }
    right = right && memcmp(loads, expected, (size_t)ranks * sizeof *loads) == 0;
    tap_ok(right, "%d items on %d ranks: each goes to the lowest rank with the least load", count, ranks);
    int64_t mean = sum_of(loads, ranks) / ranks;
    bool even = true;
    for (int r = 0; r < ranks; r++)
        even = even && (loads[r] <= mean + 1 + largest_of(costs, count) || loads[r] == start[r]);
    tap_ok(even, "%d ranks: none is above the mean by more than one item", ranks);
    alloc_free(owner);
    alloc_free(loads);
    alloc_free(costs);
}

/* --- links --- */

/* Deals `count` links whose rank is random, some ranks having none. */
static void test_links(int ranks, int count, int64_t modulus, const char *what)
{
    struct random random = random_seed(9 + (uint64_t)ranks);
    int64_t *costs = alloc_array((size_t)count, sizeof *costs);
    int64_t *loads = alloc_array(2 * (size_t)ranks, sizeof *loads), *after = loads + ranks;
    int *rank_of = alloc_array(3 * (size_t)count, sizeof *rank_of);
    int *to = rank_of + count, *again = to + count, planned, sent = 0;
    struct transfer *plan = alloc_array(2 * (size_t)ranks, sizeof *plan);
    int64_t *own = alloc_array((size_t)count, sizeof *own);
    bool right = true;
    for (int i = 0; i < count; i++) {
        costs[i] = 1 + (int64_t)(random_bits(&random) % (uint64_t)modulus);
        rank_of[i] = (int)(random_bits(&random) % (uint64_t)ranks) / 3 * 3;
        loads[rank_of[i]] += costs[i];
    }
    planned = plan_transfers(loads, ranks, plan);
    for (int r = 0; r < ranks; r++) {
        int mine = 0;
        for (int i = 0; i < count; i++)
            if (rank_of[i] == r)
                own[mine++] = costs[i];
        links_deal_out(own, mine, plan, planned, r, to);
        links_deal_out(own, mine, plan, planned, r, again);
        right = right && memcmp(to, again, (size_t)mine * sizeof *to) == 0;
        for (int i = 0; i < mine; i++) {
            right = right && to[i] >= 0 && to[i] < ranks;
            after[to[i]] += own[i];
            sent += to[i] != r;
        }
    }
    int64_t mean = sum_of(loads, ranks) / ranks, before = largest_of(loads, ranks);
    tap_ok(right && sum_of(after, ranks) == sum_of(loads, ranks),
           "%d %s on %d ranks: each has one rank, whenever it is asked", count, what, ranks);
    tap_ok(largest_of(after, ranks) <= before &&
               (ranks > 64 || largest_of(after, ranks) <= mean + 1 + ranks * modulus / 2),
           "%d ranks: the largest load does not grow (%lld, then %lld; mean %lld; %d sent)", ranks,
           (long long)before, (long long)largest_of(after, ranks), (long long)mean, sent);
    alloc_free(own);
    alloc_free(plan);
    alloc_free(rank_of);
    alloc_free(loads);
    alloc_free(costs);
}

static void test_loads(void)
{
    struct link open = {.seen = LINK_OPEN, .cost = compact8(1000.0)}, link = {.cost = compact8(1000.0)};
    tap_ok(link_load(&open) < link_load(&link) / 10, "an open link takes little, whatever it took before");
}

static void test_moving(void)
{
    const int64_t empty[4] = {0, 0, 0, 0}, equal[4] = {7, 7, 7, 7}, high[4] = {4000, 0, 0, 0};
    const int64_t little[4] = {100, 0, 0, 0}, one[1] = {1000000}, many[1024] = {2000};
    tap_ok(!moving_pays(empty, 4) && !moving_pays(equal, 4) && !moving_pays(one, 1),
           "nothing moves where loads are empty or equal, or on one rank");
    tap_ok(moving_pays(high, 4) && !moving_pays(little, 4), "links move where that saves more than it takes");
    tap_ok(moving_pays(many, 1024), "to few of many ranks, too");
}

static void test_limit(void)
{
    const int64_t much[4] = {400000, 0, 0, 0}, little[4] = {1, 1, 1, 1};
    tap_ok(links_limit(much, 4) > 50000 && links_limit(much, 4) < 100000,
           "ranks stop before they have done what the mean rank has to do");
    tap_ok(links_limit(much, 1) == INT64_MAX, "but not one rank alone");
    tap_ok(links_limit(little, 4) > 1000, "nor before they have split a few links");
}

int main(void)
{
    for (int ranks = 1; ranks <= 1024; ranks *= 4)
        test_items(ranks, 3000);
    test_items(7, 0);
    for (int ranks = 1; ranks <= 1024; ranks *= 4) {
        test_links(ranks, 5000, 1000, "links");
        test_links(ranks, 5000, 1, "links that cost the same");
    }
    test_links(16, 0, 1, "links");
    test_links(64, 10, 1000, "links");
    test_loads();
    test_moving();
    test_limit();
    tap_ok(alloc_balance() == 0, "all is freed");
    return tap_done();
}
