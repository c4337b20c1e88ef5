/* Homes of roots: every root has one, sums of weights are even, and the answer is the
 * same for any caller. */
#include "mpi/assign.h"

#include "geom/alloc.h"
#include "tests/random.h"
#include "tests/tap.h"

static void test_even_sums(int32_t roots, int ranks)
{
    struct random random = random_seed(5);
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    int *owner = alloc_array((size_t)roots, sizeof *owner);
    int64_t *sums = alloc_array((size_t)ranks, sizeof *sums);
    int64_t total = 0, biggest = 0, largest = 0;
    for (int32_t i = 0; i < roots; i++)
        weights[i] = (int64_t)(1e6 * random_unit(&random) * random_unit(&random));
    items_deal(weights, roots, ranks, owner);
    bool in_range = true;
    for (int32_t i = 0; i < roots; i++) {
        in_range = in_range && owner[i] >= 0 && owner[i] < ranks;
        sums[owner[i]] += weights[i];
        total += weights[i];
        biggest = weights[i] > biggest ? weights[i] : biggest;
    }
    for (int r = 0; r < ranks; r++)
        largest = sums[r] > largest ? sums[r] : largest;
    tap_ok(in_range, "%d roots on %d ranks: all have a home", (int)roots, ranks);
    double mean = (double)total / ranks;
    double best =
        mean > (double)biggest ? mean : (double)biggest; /* no plan is below this */
    tap_ok((double)largest <= 4.0 / 3.0 * best, "largest sum %.3f of the best possible",
           (double)largest / best);
    alloc_free(weights);
    alloc_free(owner);
    alloc_free(sums);
}

/* Graham's rule by brute force: the heaviest root that is left goes to the lowest rank
 * with the smallest sum. Half of the weights are equal. */
static void test_rule(int32_t roots, int ranks)
{
    struct random random = random_seed(11);
    int64_t *weights = alloc_array((size_t)roots, sizeof *weights);
    int64_t *sums = alloc_array((size_t)ranks, sizeof *sums);
    int *owner = alloc_array((size_t)roots, sizeof *owner);
    bool *dealt = alloc_array((size_t)roots, sizeof *dealt), right = true;
    for (int32_t i = 0; i < roots; i++)
        weights[i] = i % 2 ? 50 : (int64_t)(random_bits(&random) % 100);
    items_deal(weights, roots, ranks, owner);
    for (int32_t turn = 0; turn < roots; turn++) {
        int32_t heaviest = -1;
        int least = 0;
        for (int32_t i = 0; i < roots; i++)
            if (!dealt[i] && (heaviest < 0 || weights[i] > weights[heaviest]))
                heaviest = i;
        for (int r = 1; r < ranks; r++)
            least = sums[r] < sums[least] ? r : least;
        right = right && owner[heaviest] == least;
        sums[least] += weights[heaviest];
        dealt[heaviest] = true;
    }
    tap_ok(right, "%d roots on %d ranks: the heaviest first, to the least sum",
           (int)roots, ranks);
    alloc_free(weights);
    alloc_free(sums);
    alloc_free(owner);
    alloc_free(dealt);
}

int main(void)
{
    for (int ranks = 1; ranks <= 256; ranks *= 4)
        test_rule(700, ranks);
    test_even_sums(1000, 7);
    test_even_sums(1000, 1);
    test_even_sums(36, 16);
    test_even_sums(3, 8);
    return tap_done();
}
