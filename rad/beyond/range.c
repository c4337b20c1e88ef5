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

/* Finds the extremes of a patch, from those of its children. */
static void find_extremes(const struct forest *forest, int64_t p, int band,
                          struct extremes *extremes)
{
    const struct patch *patch = &forest->patches[p];
    const struct extremes *child = &extremes[patch->children];
    double number = number_of(forest->radiosity[p], band);
    struct extremes own = {number, number};
    for (int k = 0; k < 4 && !patch_is_leaf(patch); k++) {
        own.low = real_min(own.low, child[k].low);
        own.high = real_max(own.high, child[k].high);
    }
    extremes[p] = own;
}

void forest_raise_ranges(const struct forest *forest, int band, const double *scale,
                         float *ranges)
{
    struct extremes *extremes = alloc_array((size_t)forest->count, sizeof *extremes);
    for (int64_t p = forest->count - 1; p >= 0; p--) {
        find_extremes(forest, p, band, extremes);
        double factor = scale[forest->patches[p].id.root];
        ranges[p] = fmaxf(ranges[p],
                          (float)(factor * (extremes[p].high - extremes[p].low)));
    }
    alloc_free(extremes);
}

void forest_bound(struct forest *forest, const int32_t *patches, int64_t count)
{
    size_t all = (size_t)forest->count;
    struct extremes *extremes = alloc_array(all, sizeof *extremes);
    alloc_free(forest->ranges);
    forest->ranged = forest->count;
    forest->ranges = alloc_array(all, sizeof *forest->ranges);
    for (int64_t i = count - 1; i >= 0; i--) {
        int32_t p = patches ? patches[i] : (int32_t)i;
        const struct patch *patch = &forest->patches[p];
        const struct extremes *child = &extremes[patch->children];
        find_extremes(forest, p, BANDS, extremes);
        for (int k = 0; k < 4 && !patch_is_leaf(patch); k++)
            forest->ranges[p] =
                fmaxf(forest->ranges[p], (float)(child[k].high - child[k].low));
    }
    alloc_free(extremes);
}

double forest_range_within(const struct forest *forest, int32_t patch)
{
    return patch < forest->ranged ? (double)forest->ranges[patch] : 0.0;
}
