/* Homes of roots: every root has one, area sums are even, and the answer is the same for any
 * caller. */
#include "mpi/assign.h"

#include "tests/random.h"
#include "tests/tap.h"

/* A scene with random areas only: nothing else is read. */
static struct scene *scene_of_areas(int32_t count)
{
    struct random random = random_seed(5);
    struct scene *scene = scene_create(count, 1);
    for (int32_t i = 0; i < count; i++)
        scene->areas[i] = random_unit(&random) * random_unit(&random);
    return scene;
}

static void test_even_sums(int32_t roots, int ranks)
{
    struct scene *scene = scene_of_areas(roots);
    int *owner = alloc_array((size_t)roots, sizeof *owner);
    double *sums = alloc_array((size_t)ranks, sizeof *sums);
    double total = 0.0, biggest = 0.0, largest = 0.0;
    roots_assign(scene, ranks, owner);
    bool in_range = true;
    for (int32_t i = 0; i < roots; i++) {
        in_range = in_range && owner[i] >= 0 && owner[i] < ranks;
        sums[owner[i]] += scene->areas[i];
        total += scene->areas[i];
        biggest = scene->areas[i] > biggest ? scene->areas[i] : biggest;
    }
    for (int r = 0; r < ranks; r++)
        largest = sums[r] > largest ? sums[r] : largest;
    tap_ok(in_range, "%d roots on %d ranks: all have a home", (int)roots, ranks);
    double best = total / ranks > biggest ? total / ranks : biggest; /* no plan is below this */
    tap_ok(largest <= 4.0 / 3.0 * best, "largest sum %.3f of the best possible %.3f", largest, best);
    alloc_free(owner);
    alloc_free(sums);
    scene_destroy(scene);
}

int main(void)
{
    test_even_sums(1000, 7);
    test_even_sums(1000, 1);
    test_even_sums(36, 16);
    test_even_sums(3, 8);
    return tap_done();
}
