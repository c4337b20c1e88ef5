/* Ranges of radiosity. A child is always created after its parent, so one loop over the
 * local numbers downwards meets children before parents. */
#include "rad/beyond/range.h"

#include <math.h>

#include "geom/alloc.h"

void forest_bound(struct forest *forest)
{
    RESERVE(forest->extremes, &forest->extremes_capacity, forest->count);
    forest->bounded = forest->count;
    for (int64_t p = forest->count - 1; p >= 0; p--) {
        const struct patch *patch = &forest->patches[p];
        float brightness = (float)rgb_sum(forest->radiosity[p]);
        struct extremes *own = &forest->extremes[p];
        const struct extremes *child = &forest->extremes[patch->children];
        *own = (struct extremes){brightness, brightness};
        for (int k = 0; k < 4 && !patch_is_leaf(patch); k++) {
            own->low = fminf(own->low, child[k].low);
            own->high = fmaxf(own->high, child[k].high);
        }
    }
}

/* 0 of a patch that is newer, whose leaves were one. */
static double range_of(const struct forest *forest, int32_t patch)
{
    if (patch >= forest->bounded)
        return 0.0;
    struct extremes e = forest->extremes[patch];
    return (double)(e.high - e.low);
}

double forest_range_within(const struct forest *forest, int32_t patch)
{
    double range = 0.0;
    int32_t children = forest->patches[patch].children;
    for (int k = 0; k < 4 && children > 0; k++)
        range = fmax(range, range_of(forest, children + k));
    return range;
}
