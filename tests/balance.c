/* Balance: every item, link and root of a row has one owner, the same whoever asks; loads
 * end as even as the costs allow, for up to 1,024 ranks, empty and equal loads too; wrong
 * predictions are made good. */
#include "mpi/balance.h"

#include <math.h>

#include "rad/linking.h"
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
    const int64_t much[4] = {400000, 0, 0, 0}, little[4] = {100, 100, 100, 100};
    int stages = 0;
    while (stages < 100 && links_limit(much, 4, stages) < INT64_MAX)
        stages++;
    tap_ok(stages > 0 && stages < 10 && links_limit(much, 4, 0) > 50000 && links_limit(much, 4, 0) < 100000,
           "ranks stop before they have done what the mean rank has to do, %d times", stages);
    tap_ok(links_limit(much, 1, 0) == INT64_MAX && links_limit(little, 4, 0) == INT64_MAX,
           "but not one rank alone, nor where there is little to do");
}

/* --- rows --- */

/* Rows of which the prediction is wrong: what a root really takes, thousandths. */
struct rows {
    int32_t count;
    int ranks;
    int64_t *rests, *samples, *each; /* [count] predicted, of the rest and of the sample; really */
    uint8_t *seen;                   /* [count * count] how often a root was linked */
    bool is_right;
};

/* One row in 50 is heavy; what is predicted for the rest is off by a factor of up to 4. Or all rows are
 * alike, and the factor is up to 1.4. */
static struct rows rows_make(int32_t count, bool alike)
{
    struct rows rows = {.count = count, .is_right = true};
    struct random random = random_seed(77);
    rows.rests = alloc_array((size_t)count, sizeof *rows.rests);
    rows.samples = alloc_array((size_t)count, sizeof *rows.samples);
    rows.each = alloc_array((size_t)count, sizeof *rows.each);
    rows.seen = alloc_array((size_t)count * (size_t)count, 1);
    for (int32_t place = 0; place < count; place++) {
        int64_t heavy = random_below(&random, 50) == 0 ? 20 : 1;
        int32_t length = linking_row_length(count, place);
        rows.rests[place] = alike ? 20000 : heavy * (int64_t)random_below(&random, 45000);
        rows.samples[place] = rows.rests[place] / LINKING_SAMPLE;
        double factor = exp2(alike ? random_between(&random, -0.5, 0.5)
                                   : random_between(&random, -2.0, 2.0));
        rows.each[place] = length > 0 ? (int64_t)(1000.0 * factor * (double)rows.rests[place] / length)
                                      : 0;
    }
    return rows;
}

static void rows_free(struct rows *rows)
{
    alloc_free(rows->rests);
    alloc_free(rows->samples);
    alloc_free(rows->each);
    alloc_free(rows->seen);
}

/* Returns the work; what is left of the part goes into the news, or is done too. */
static int64_t do_part(struct rows *rows, const struct row_part *part, struct row_news *news)
{
    int64_t each = rows->each[part->place], roots = part->to - part->from;
    int64_t limit = each > 0 ? 1 + 1000 * row_limit(part) / each : roots;
    int32_t stop = part->from + (int32_t)(limit < roots ? limit : roots);
    for (int32_t i = part->from; i < stop; i++)
        rows->seen[(int64_t)part->place * rows->count + i]++;
    int64_t work = each * (stop - part->from) / 1000;
    if (stop == part->to)
        return work;
    struct row_part rest = row_rest(part, stop, work), cut[ROW_PARTS_MAX];
    rows->is_right = rows->is_right && rest.from == stop && rest.to == part->to && rest.cost >= 0;
    if (row_news_add(news, &rest, rows->ranks))
        return work;
    int count = row_cut(&rest, cut);
    for (int i = 0; i < count; i++)
        work += do_part(rows, &cut[i], news);
    return work;
}

/* What ranks do between two exchanges of news, and the clocks after it. */
static void do_stage(struct rows *rows, const struct row_deal *deal, struct row_news *own,
                     int64_t *clocks)
{
    int64_t *worked = alloc_array((size_t)deal->ranks, sizeof *worked);
    for (int64_t i = deal->first; i < deal->end; i++) {
        int rank = deal->owner[i];
        rows->is_right = rows->is_right && rank >= 0 && rank < deal->ranks;
        if (row_stage_is_over(deal, rank, worked[rank], &own[rank]))
            continue;
        worked[rank] += do_part(rows, &deal->parts[i], &own[rank]);
        own[rank].begun++;
    }
    for (int r = 0; r < deal->ranks; r++)
        clocks[r] += worked[r];
    alloc_free(worked);
}

/* Samples, and the rows that ranks go on with. */
static void do_samples(struct rows *rows, const int *sampler, struct row_news *own, int64_t *sampled,
                       int64_t *clocks)
{
    for (int32_t place = 0; place < rows->count; place++)
        sampled[sampler[place]] += rows->samples[place];
    for (int32_t place = 0; place < rows->count; place++) {
        struct row_part whole = row_whole(rows->count, place, rows->rests[place]);
        if (row_goes_on(place, rows->rests[place]))
            clocks[sampler[place]] += do_part(rows, &whole, &own[sampler[place]]);
    }
}

/* Follows a deal; the last clock is at most `most` times the mean work. */
static void test_rows(int32_t count, int ranks, bool alike, double most)
{
    struct rows rows = rows_make(count, alike);
    rows.ranks = ranks;
    size_t n = (size_t)ranks;
    int64_t *sampled = alloc_array(n, sizeof *sampled), *clocks = alloc_array(n, sizeof *clocks);
    struct row_news *own = alloc_array(n, sizeof *own), *told = alloc_array(n, sizeof *told);
    int *sampler = alloc_array((size_t)count, sizeof *sampler), stages = 0;
    double work = 0.0;
    row_deal_samples(rows.samples, count, ranks, sampler);
    do_samples(&rows, sampler, own, sampled, clocks);
    for (int r = 0; r < ranks; r++)
        clocks[r] += sampled[r];
    struct row_deal deal = row_deal_start(rows.rests, sampler, count, sampled, ranks);
    do {
        for (int r = 0; r < ranks; r++) {
            own[r].clock = clocks[r] = row_clock(&deal, clocks[r]);
            told[r] = own[r];
            own[r].count = own[r].begun = 0;
        }
        row_deal_next(&deal);
        do_stage(&rows, &deal, own, clocks);
        stages++;
    } while (row_deal_hear(&deal, told));
    for (int32_t place = 0; place < count; place++) {
        int32_t length = linking_row_length(count, place);
        work += (double)rows.samples[place] + 1e-3 * (double)rows.each[place] * length;
        for (int32_t i = 0; i < count; i++)
            rows.is_right = rows.is_right && rows.seen[(int64_t)place * count + i] == (i < length);
    }
    double mean = work / ranks;
    tap_ok(rows.is_right && deal.end == deal.count, "%d rows on %d ranks: each root is linked once",
           (int)count, ranks);
    tap_ok((double)largest_of(clocks, ranks) <= most * mean,
           "%d ranks: predictions off by up to %s, the last clock %.3f of the mean after %d stages",
           ranks, alike ? "1.4" : "4",
           mean > 0.0 ? (double)largest_of(clocks, ranks) / mean : 1.0, stages);
    row_deal_end(&deal);
    rows_free(&rows);
    alloc_free(sampler);
    alloc_free(told);
    alloc_free(own);
    alloc_free(clocks);
    alloc_free(sampled);
}

/* What ranks tell has room for as much as they may add, and a rank that has no room left begins nothing. */
static void test_news(int ranks, int64_t least)
{
    const struct row_part rest = {.cost = 1, .to = 1};
    const int64_t sampled[1024] = {0}, rests = 0;
    struct row_news news = {0};
    int sampler = 0;
    struct row_deal deal = row_deal_start(&rests, &sampler, 0, sampled, ranks);
    int64_t before = 0; /* additions after which the stage is not over */
    while (news.count < 100 && row_news_add(&news, &rest, ranks))
        before += !row_stage_is_over(&deal, 0, 0, &news);
    tap_ok(before == (ranks > 1 ? news.count - 1 : 0) && news.count >= least && news.count <= ROW_NEWS &&
               row_news_size(ranks) >= offsetof(struct row_news, left) + (size_t)news.count * sizeof rest &&
               row_news_size(ranks) * (size_t)ranks <= 1 << 19,
           "%d ranks: %lld stopped parts are told, in %lld bytes; then a rank has done enough", ranks,
           (long long)news.count, (long long)row_news_size(ranks));
    row_deal_end(&deal);
}

static void test_parts(void)
{
    bool right = true;
    struct row_part cut[ROW_PARTS_MAX];
    int before = 0;
    for (int64_t cost = 0; cost < INT64_C(1) << 40; cost = 2 * cost + 1) {
        struct row_part whole = row_whole(5000, 3, cost);
        int count = row_cut(&whole, cut);
        right = right && count >= before && cut[0].from == 0 && cut[count - 1].to == 2500;
        for (int i = 1; i < count; i++)
            right = right && cut[i].from == cut[i - 1].to && cut[i].to > cut[i].from;
        before = count;
    }
    tap_ok(right && before == ROW_PARTS_MAX, "heavier rows have more parts, up to %d", before);
    struct row_part few = {.cost = 1000000, .place = 1, .from = 5, .to = 8};
    tap_ok(row_cut(&few, cut) == 3, "no part is without a root");
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
    test_parts();
    test_news(1, 0);
    test_news(8, 64);
    test_news(1024, 16);
    for (int ranks = 1; ranks <= 64; ranks *= 4)
        test_rows(3000, ranks, false, 1.01);
    test_rows(3000, 256, false, 1.12);
    for (int ranks = 8; ranks <= 64; ranks *= 2)
        test_rows(3000, ranks, true, 1.05);
    test_rows(1, 4, false, 4.0);
    test_rows(0, 4, false, 1.0);
    tap_ok(alloc_balance() == 0, "all is freed");
    return tap_done();
}
