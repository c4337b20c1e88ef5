/* Dealing: every link has one rank, the same whoever asks; loads end as even as the costs
 * allow, for up to 1,024 ranks, empty and equal loads too. */
#include "mpi/balance.h"

#include <string.h>

#include "geom/alloc.h"
#include "rad/model.h"
#include "tests/random.h"
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

/* Links whose rank is random, two of three ranks having none. */
struct deck {
    int ranks, count;
    int64_t *costs, *loads; /* [count], [ranks] */
    int *rank_of;           /* [count] */
};

static struct deck deck_create(int ranks, int count, int64_t modulus)
{
    struct random random = random_seed(9 + (uint64_t)ranks);
    struct deck deck = {.ranks = ranks, .count = count,
                        .costs = alloc_array((size_t)count, sizeof *deck.costs),
                        .loads = alloc_array((size_t)ranks, sizeof *deck.loads),
                        .rank_of = alloc_array((size_t)count, sizeof *deck.rank_of)};
    for (int i = 0; i < count; i++) {
        deck.costs[i] = 1 + (int64_t)(random_bits(&random) % (uint64_t)modulus);
        deck.rank_of[i] = (int)(random_bits(&random) % (uint64_t)ranks) / 3 * 3;
        deck.loads[deck.rank_of[i]] += deck.costs[i];
    }
    return deck;
}

static void deck_free(struct deck *deck)
{
    alloc_free(deck->costs);
    alloc_free(deck->loads);
    alloc_free(deck->rank_of);
}

/* Deals all links. after[r]: loads, dealt[r]: links then. False if a link has no rank, or
 * another one when asked again. */
static bool deal(const struct deck *deck, enum balance balance, int64_t *after,
                 int64_t *dealt)
{
    size_t count = (size_t)deck->count;
    int64_t *own = alloc_array(count, sizeof *own);
    int *to = alloc_array(count, sizeof *to), *again = alloc_array(count, sizeof *again);
    bool right = true;
    for (int r = 0; r < deck->ranks; r++) {
        struct loads loads = {deck->loads, deck->ranks, r};
        int mine = 0;
        for (int i = 0; i < deck->count; i++)
            if (deck->rank_of[i] == r)
                own[mine++] = deck->costs[i];
        DEALINGS[balance](loads, own, mine, to);
        DEALINGS[balance](loads, own, mine, again);
        right = right && memcmp(to, again, (size_t)mine * sizeof *to) == 0;
        for (int i = 0; i < mine && right; i++) {
            right = to[i] >= 0 && to[i] < deck->ranks;
            after[right ? to[i] : 0] += own[i];
            dealt[right ? to[i] : 0]++;
        }
    }
    alloc_free(own);
    alloc_free(to);
    alloc_free(again);
    return right;
}

/* Greedily the largest load does not grow, and no rank is above the mean by more than
 * half a link for each of the senders that it receives from. In turn no rank has more
 * links than the mean by more than one for each rank. */
static void test_dealing(int ranks, int count, int64_t modulus, const char *links)
{
    struct deck deck = deck_create(ranks, count, modulus);
    for (enum balance balance = BALANCE_GREEDY; balance <= BALANCE_DEFAULT; balance++) {
        int64_t *after = alloc_array((size_t)ranks, sizeof *after);
        int64_t *dealt = alloc_array((size_t)ranks, sizeof *dealt);
        bool right = deal(&deck, balance, after, dealt);
        int64_t mean = sum_of(deck.loads, ranks) / ranks;
        int64_t before = largest_of(deck.loads, ranks), now = largest_of(after, ranks);
        const char *name = balance == BALANCE_GREEDY ? "greedily" : "in turn";
        tap_ok(right && sum_of(after, ranks) == sum_of(deck.loads, ranks),
               "%d %s on %d ranks, %s: each has one rank, whenever it is asked", count,
               links, ranks, name);
        if (balance == BALANCE_GREEDY)
            tap_ok(now <= before && (ranks > 64 || now <= mean + 1 + ranks * modulus / 2),
                   "the largest load does not grow (%lld, then %lld; mean %lld)",
                   (long long)before, (long long)now, (long long)mean);
        else
            tap_ok(largest_of(dealt, ranks) <= count / ranks + ranks,
                   "the largest number of links is %lld; mean %d",
                   (long long)largest_of(dealt, ranks), count / ranks);
        alloc_free(after);
        alloc_free(dealt);
    }
    deck_free(&deck);
}

/* Sec. 3.3.2: the sender keeps the mean, and deals in turn. */
static void test_round_robin(void)
{
    const int64_t loads[3] = {90, 0, 0}, costs[9] = {10, 10, 10, 10, 10, 10, 10, 10, 10};
    const int expected[9] = {0, 1, 2, 0, 1, 2, 0, 1, 2};
    int to[9];
    deal_greedily((struct loads){loads, 3, 0}, costs, 9, to);
    tap_ok(memcmp(to, expected, sizeof to) == 0,
           "equal links go in turn to two receivers");
    const int64_t half[3] = {60, 30, 0};
    deal_greedily((struct loads){half, 3, 1}, costs, 3, to);
    tap_ok(to[0] == 1 && to[1] == 1 && to[2] == 1, "a rank with the mean sends nothing");
    deal_greedily((struct loads){half, 3, 0}, costs, 6, to);
    int sent = 0;
    for (int i = 0; i < 6; i++)
        sent += to[i] == 2;
    tap_ok(sent == 3, "a sender sends its excess to the receiver");
}

int main(void)
{
    for (int ranks = 1; ranks <= 1024; ranks *= 4) {
        test_dealing(ranks, 5000, 1000, "links");
        test_dealing(ranks, 5000, 1, "links that cost the same");
    }
    test_dealing(16, 0, 1, "links");
    test_dealing(64, 10, 1000, "links");
    test_round_robin();
    return tap_done();
}
