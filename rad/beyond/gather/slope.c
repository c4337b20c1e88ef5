/* As a sender a leaf is no constant: over a leaf with sisters B is linear,
 *
 *     B(x) = b + s sum over k of b_k (w_k - 1/3),    s = 1, of the middle child s = -1,
 *
 * with the barycentric coordinates w of x in the leaf and the means b_0, b_1, b_2 of its
 * parent's outer children: the linear function with these means. (Over the parent itself
 * s is 2.) B(x) is linear in the radiosities, too, so the row has terms for the sisters,
 * which sum to 0. If B were constant over leaves as wide as the gap between them, each
 * reflection would move light outwards. Where the linear function is below 0 somewhere,
 * its slope is made less.
 *
 * Rejected: B interpolated between shared corners of neighbours. Interpolation needs to
 * know over which edges light goes on smoothly, and at shadows, where interpolation
 * matters, light does not.
 *
 * Over a leaf with an exact row the rest is the bend: B of a leaf less the linear
 * function over its parent. Its error comes back as often as light is reflected, so less
 * is allowed where little is absorbed:
 *
 *     area * bend^2  <=  BENT * absorptance * epsilon * sum of area * (rho H)^2,
 *
 * in each band apart, since dim bands are to be right, too. Links make the mesh for the
 * brightest band. It may be too coarse by more than a level for a dim band that is
 * reflected more often, and beside an edge where much is reflected. */
#include "rad/beyond/gather/slope.h"

#include <math.h>

static const double BENT = 0.002;

/* Where B is smooth, the error of a bend over a child is the part FALL of the error over
 * its parent, a sixteenth for the square of the bend, a quarter for the area; a child is
 * split, too, if its error is more than MUCH times the allowed one. */
static const double FALL = 1.0 / 64.0, MUCH = 64.0;

/* How far apart radiosities are, over all bands; or by `scale`: the largest difference of
 * a band as a part of the band's mean, times the mean over all bands. */
static double difference(struct rgb a, struct rgb b, const struct rgb *scale)
{
    double most = 0.0;
    if (!scale)
        return fabs(rgb_sum(a) - rgb_sum(b));
    for (int c = 0; c < BANDS; c++)
        most = real_max(most, scale->band[c] * fabs(a.band[c] - b.band[c]));
    return most;
}

/* The factor, at most 1, of a parent's slope that keeps B from falling below 0 over any
 * child, [4] of them. */
static double slope_part(const struct rgb *b, struct rgb middle)
{
    double part = 1.0;
    for (int c = 0; c < BANDS; c++) {
        double low = real_min(b[0].band[c], real_min(b[1].band[c], b[2].band[c]));
        double high = real_max(b[0].band[c], real_max(b[1].band[c], b[2].band[c]));
        double fall = middle.band[c] - low, rise = high - middle.band[c];
        if (low < part * fall)
            part = low / fall;
        if (b[3].band[c] < part * rise)
            part = b[3].band[c] / rise;
    }
    return part > 0.0 ? part : 0.0;
}

struct gather_slope slope_of(const struct forest *forest, const uint8_t *cut,
                             int32_t patch, const struct rgb *scale)
{
    const struct patch *patches = forest->patches;
    bool leaf = patch_is_leaf(&patches[patch]);
    int32_t parent = leaf ? patches[patch].parent : patch;
    if (parent < 0)
        return (struct gather_slope){.rise = 0.0};
    struct gather_slope slope = {.first = patches[parent].children};
    if (cut && cut[parent])
        return slope;
    const struct rgb *b = forest->radiosity + slope.first;
    struct rgb middle;
    for (int c = 0; c < BANDS; c++)
        middle.band[c] = (b[0].band[c] + b[1].band[c] + b[2].band[c]) / 3.0;
    for (int k = 0; k < 3; k++)
        slope.range = real_max(slope.range, difference(b[k], middle, scale));
    if (slope.range > 0.0)
        slope.rise = slope_part(b, middle) *
                     (!leaf ? 2.0 : patch == slope.first + 3 ? -1.0 : 1.0);
    return slope;
}

struct rgb light_by_parent(const struct forest *forest, int32_t patch)
{
    const struct patch *patches = forest->patches;
    int32_t parent = patches[patch].parent, grandparent = patches[parent].parent;
    struct rgb light = forest->radiosity[parent];
    int k = patch - patches[parent].children;
    if (grandparent < 0 || k == 3)
        return light;
    int32_t first = patches[grandparent].children;
    double s = parent == first + 3 ? -1.0 : 1.0;
    for (int c = 0; c < BANDS; c++) {
        for (int j = 0; j < 3; j++) {
            double w = j == k ? 2.0 / 3.0 : 1.0 / 6.0; /* of the patch's centroid */
            light.band[c] += s * (w - 1.0 / 3.0) * forest->radiosity[first + j].band[c];
        }
        light.band[c] = fmax(0.0, light.band[c]);
    }
    return light;
}

/* The squares of B of a leaf less the linear function over its parent, band by band. Over
 * a root this function is constant, and some children have its B by chance: there the
 * child most off counts for all. */
static struct rgb bends_of(const struct forest *forest, int32_t leaf)
{
    const struct patch *patches = forest->patches;
    int32_t parent = patches[leaf].parent, first = leaf, count = parent < 0 ? 0 : 1;
    struct rgb bends = {{0.0, 0.0, 0.0}};
    if (parent >= 0 && patches[parent].parent < 0) {
        first = patches[parent].children;
        count = 4;
    }
    for (int32_t child = first; child < first + count; child++) {
        struct rgb line = light_by_parent(forest, child);
        for (int c = 0; c < BANDS; c++) {
            double off = forest->radiosity[child].band[c] - line.band[c];
            bends.band[c] = fmax(bends.band[c], off * off);
        }
    }
    return bends;
}

int slope_splits(const struct model *model, int32_t leaf, const struct rgb *all)
{
    struct rgb bends = bends_of(model->forest, leaf);
    double part = BENT * model->absorptance * model->criterion.epsilon;
    double area = forest_area(model->forest, leaf);
    int splits = 0;
    for (int c = 0; c < BANDS; c++) {
        if (!(area * bends.band[c] > part * all->band[c]))
            continue;
        int levels = 1;
        double error = FALL * area * bends.band[c];
        for (; levels < ID_MAX_LEVEL && error > MUCH * part * all->band[c]; error *= FALL)
            levels++;
        splits = levels > splits ? levels : splits;
    }
    return splits;
}
