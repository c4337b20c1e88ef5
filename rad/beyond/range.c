/* Ranges of radiosity. A child is always created after its parent, so one loop over the
 * local numbers downwards meets children before parents. */
#include "rad/beyond/range.h"

#include <math.h>

#include "geom/alloc.h"

/* The least and the most below a patch, W/m^2. */
struct extremes {
    double low, high;
};

/* Sums are floats, which hide the rounding of means of equal leaves. */
static double number_of(struct rgb b, int band)
{
    return band < BANDS ? b.band[band] : (double)(float)rgb_sum(b);
}

void forest_raise_ranges(const struct forest *forest, int band, const double *scale,
                         float *ranges)
{
    struct extremes *extremes = alloc_array((size_t)forest->count, sizeof *extremes);
    for (int64_t p = forest->count - 1; p >= 0; p--) {
        const struct patch *patch = &forest->patches[p];
        const struct extremes *child = &extremes[patch->children];
        double number = number_of(forest->radiosity[p], band);
        struct extremes own = {number, number};
        for (int k = 0; k < 4 && !patch_is_leaf(patch); k++) {
            own.low = real_min(own.low, child[k].low);
            own.high = real_max(own.high, child[k].high);
        }
        extremes[p] = own;
        double factor = scale ? scale[patch->id.root] : 1.0;
        ranges[p] = fmaxf(ranges[p], (float)(factor * (own.high - own.low)));
    }
    alloc_free(extremes);
}

void forest_bound(struct forest *forest)
{
    alloc_free(forest->ranges);
    forest->ranged = forest->count;
    forest->ranges = alloc_array((size_t)forest->count, sizeof *forest->ranges);
    forest_raise_ranges(forest, BANDS, NULL, forest->ranges);
}

double forest_range_within(const struct forest *forest, int32_t patch)
{
    double range = 0.0;
    int32_t children = forest->patches[patch].children; /* newer ones were one leaf */
    for (int k = 0; k < 4 && children > 0 && children < forest->ranged; k++)
        range = fmax(range, (double)forest->ranges[children + k]);
    return range;
}
