/* The greedy plan: every unit of load is placed once, no rank both sends and receives,
 * the largest load never grows, and the end is the mean, for up to 1,024 ranks. */
#include "mpi/plan.h"

#include "tests/random.h"
#include "tests/tap.h"

/* Whether the plan is right; `count`: of its transfers. */
static bool is_right(const int64_t *loads, int ranks, int *count)
{
    struct transfer *transfers = alloc_array(2 * (size_t)ranks, sizeof *transfers);
    int64_t *now = alloc_array((size_t)ranks, sizeof *now);
    bool *sends = alloc_array((size_t)ranks, sizeof *sends);
    bool *receives = alloc_array((size_t)ranks, sizeof *receives), right = true;
    int64_t total = 0, after = 0, largest = 0;
    for (int r = 0; r < ranks; r++) {
        now[r] = loads[r];
        total += loads[r];
        largest = loads[r] > largest ? loads[r] : largest;
    }
    *count = plan_transfers(loads, ranks, transfers);
    for (int t = 0; t < *count; t++) {
        right = right && transfers[t].load > 0 && transfers[t].from != transfers[t].to;
        now[transfers[t].from] -= transfers[t].load;
        now[transfers[t].to] += transfers[t].load;
        sends[transfers[t].from] = true;
        receives[transfers[t].to] = true;
    }
    for (int r = 0; r < ranks; r++) {
        right = right && !(sends[r] && receives[r]) && now[r] <= largest &&
                now[r] >= total / ranks && now[r] <= total / ranks + 1;
        after += now[r];
    }
    alloc_free(transfers);
    alloc_free(now);
    alloc_free(sends);
    alloc_free(receives);
    return right && after == total;
}

static void test_paper_example(void)
{
    const int64_t loads[4] = {100, 10, 60, 30};
    struct transfer t[8];
    int count = plan_transfers(loads, 4, t);
    tap_ok(count == 3, "mean 50: three transfers");
    tap_ok(t[0].from == 0 && t[0].to == 1 && t[0].load == 40,
           "the largest sender fills the emptiest receiver first");
    tap_ok(t[1].from == 0 && t[1].to == 3 && t[1].load == 10, "then the next");
    tap_ok(t[2].from == 2 && t[2].to == 3 && t[2].load == 10,
           "the second sender follows");
}

static void test_random_loads(int ranks, int trials, uint64_t modulus)
{
    struct random random = random_seed(17 + (uint64_t)ranks);
    int64_t *loads = alloc_array((size_t)ranks, sizeof *loads);
    bool right = true, few = true;
    for (int trial = 0; trial < trials; trial++) {
        for (int r = 0; r < ranks; r++)
            loads[r] = (int64_t)(random_bits(&random) % modulus) *
                       (int64_t)(random_bits(&random) % 3); /* a third are empty */
        int count;
        right = is_right(loads, ranks, &count) && right;
        few = few && count < 2 * ranks;
    }
    tap_ok(right, "%d ranks, loads below %llu: every unit placed once, evenly", ranks,
           (unsigned long long)modulus);
    tap_ok(few, "%d ranks: fewer than 2 P transfers", ranks);
    alloc_free(loads);
}

static void test_special_loads(void)
{
    const int64_t empty[5] = {0, 0, 0, 0, 0}, equal[3] = {7, 7, 7}, one[1] = {42};
    const int64_t single[4] = {0, 0, 1, 0}, huge[2] = {INT64_C(1) << 60, 0};
    struct transfer t[16];
    int count;
    tap_ok(plan_transfers(empty, 5, t) == 0, "empty loads: nothing moves");
    tap_ok(plan_transfers(equal, 3, t) == 0, "equal loads: nothing moves");
    tap_ok(plan_transfers(one, 1, t) == 0, "one rank: nothing moves");
    tap_ok(is_right(single, 4, &count), "a single unit is placed once");
    tap_ok(is_right(huge, 2, &count), "huge loads do not overflow");
}

int main(void)
{
    test_paper_example();
    test_special_loads();
    for (int ranks = 2; ranks <= 1024; ranks *= 4)
        test_random_loads(ranks, 20, 1000000);
    test_random_loads(1024, 5, 1000000);
    test_random_loads(7, 200, 5);
    return tap_done();
}
