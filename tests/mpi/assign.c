/* Homes of roots: every root has one, by the rule. */
#include "mpi/assign.h"

#include "geom/alloc.h"
#include "tests/random.h"
#include "tests/tap.h"

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
    test_rule(3, 8);
    return tap_done();
}
