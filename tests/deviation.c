/* The error norms; the header defines them.
 *
 * The square of the error uses the product of two deviations rather than the square of
 * one less an estimate of the variance: it is the same sum, and nothing has to be
 * subtracted. */
#include "tests/deviation.h"

#include <math.h>
#include <stdlib.h>

#include "geom/alloc.h"

struct ranked {
    double error, area;
};

struct sums {
    double area, square, truth_square, absolute, difference, truth, noise;
};

static int compare_errors(const void *left, const void *right)
{
    const struct ranked *a = left, *b = right;
    return (a->error > b->error) - (a->error < b->error);
}

/* Adds a sample; returns its |B - T|, summed over bands. */
static double add_sample(struct sums *sums, const struct sample *sample)
{
    double error = 0.0;
    sums->area += sample->area;
    for (int c = 0; c < BANDS; c++) {
        double r = sample->truth[0].band[c], s = sample->truth[1].band[c];
        double b = sample->value.band[c];
        sums->square += sample->area * (b - r) * (b - s);
        sums->truth_square += sample->area * r * s;
        sums->truth += sample->area * 0.5 * (r + s);
        sums->noise += sample->area * 0.25 * (r - s) * (r - s);
        sums->difference += sample->area * (b - 0.5 * (r + s));
        error += fabs(b - 0.5 * (r + s));
    }
    sums->absolute += sample->area * error;
    return error;
}

static double median_of(struct ranked *ranked, int64_t count, double area)
{
    qsort(ranked, (size_t)count, sizeof *ranked, compare_errors);
    double passed = 0.0;
    int64_t middle = 0;
    while (middle + 1 < count && (passed += ranked[middle].area) < 0.5 * area)
        middle++;
    return ranked[middle].error;
}

struct deviation deviation_of(const struct sample *samples, int64_t count)
{
    struct deviation deviation = {.rms = 0.0};
    struct sums sums = {.area = 0.0};
    struct ranked *ranked = alloc_array((size_t)count, sizeof *ranked);
    for (int64_t i = 0; i < count; i++)
        ranked[i] = (struct ranked){add_sample(&sums, &samples[i]), samples[i].area};
    if (sums.truth_square > 0.0)
        deviation = (struct deviation){
            .rms = sqrt(fmax(sums.square, 0.0) / sums.truth_square),
            .l1 = sums.absolute / sums.truth,
            .median = median_of(ranked, count, sums.area) / (sums.truth / sums.area),
            .bias = sums.difference / sums.truth,
            .noise = sqrt(sums.noise / sums.truth_square),
            .square = sums.truth_square / sums.area,
        };
    alloc_free(ranked);
    return deviation;
}

double truth_noise(const struct truth *truth, const struct scene *scene, bool points)
{
    struct sample *samples = alloc_array((size_t)truth->count, sizeof *samples);
    for (int64_t i = 0; i < truth->count; i++) {
        const struct element *element = &truth->items[i];
        const struct rgb *halves = points ? element->point : element->mean;
        samples[i] = (struct sample){
            .area = element_area(element, scene),
            .truth = {halves[0], halves[1]}};
    }
    double noise = deviation_of(samples, truth->count).noise;
    alloc_free(samples);
    return noise;
}

/* --- the three answers --- */

struct list {
    struct sample *items; /* [count] */
    int64_t count;
};

/* B - E of a root. */
static struct rgb reflected(const struct scene *scene, int32_t root, struct rgb radiosity)
{
    return rgb_sub(radiosity, scene_root_material(scene, root)->emission);
}

static struct rgb mean_of(const struct element *elements, int64_t count, int half)
{
    struct rgb mean = {{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < count; i++)
        for (int c = 0; c < BANDS; c++)
            mean.band[c] += elements[i].mean[half].band[c] / (double)count;
    return mean;
}

/* A patch, which holds these elements, as a sample. */
static struct sample sample_of(const struct forest *forest, int32_t patch,
                               const struct element *elements, int64_t count)
{
    const struct patch *at = &forest->patches[patch];
    struct sample sample = {.area = forest_area(forest, patch),
                            .value = reflected(forest->scene, (int32_t)at->id.root,
                                               forest->radiosity[patch])};
    for (int half = 0; half < TRUTH_HALVES; half++)
        sample.truth[half] = mean_of(elements, count, half);
    return sample;
}

/* The leaves of a patch of these elements, or the patch if it is one element. */
static void add_leaves(const struct forest *forest, int32_t patch,
                       const struct element *elements, int64_t count, struct list *list)
{
    const struct patch *at = &forest->patches[patch];
    if (count > 1 && !patch_is_leaf(at))
        for (int k = 0; k < 4; k++)
            add_leaves(forest, at->children + k, elements + k * (count / 4), count / 4,
                       list);
    else
        list->items[list->count++] = sample_of(forest, patch, elements, count);
}

static struct deviation deviation_of_patches(const struct forest *forest,
                                             const struct truth *truth, bool roots)
{
    struct list list = {alloc_array((size_t)truth->count, sizeof *list.items), 0};
    for (int64_t i = 0; i < truth->count;) {
        const struct element *elements = &truth->items[i];
        int32_t root = (int32_t)elements->id.root;
        int64_t count = INT64_C(1) << 2 * id_level(elements->id);
        if (roots)
            list.items[list.count++] = sample_of(forest, root, elements, count);
        else
            add_leaves(forest, root, elements, count, &list);
        i += count;
    }
    struct deviation deviation = deviation_of(list.items, list.count);
    alloc_free(list.items);
    return deviation;
}

struct deviation deviation_of_leaves(const struct forest *forest,
                                     const struct truth *truth)
{
    return deviation_of_patches(forest, truth, false);
}

struct deviation deviation_of_roots(const struct forest *forest,
                                    const struct truth *truth)
{
    return deviation_of_patches(forest, truth, true);
}

bool element_is_black(const struct element *element)
{
    return rgb_sum(element->point[0]) + rgb_sum(element->point[1]) == 0.0;
}

struct deviation deviation_of_points(const struct renderer *renderer,
                                     const struct scene *scene, const struct truth *truth)
{
    struct list list = {alloc_array((size_t)truth->count, sizeof *list.items), 0};
    for (int64_t i = 0; i < truth->count; i++) {
        const struct element *element = &truth->items[i];
        int32_t root = (int32_t)element->id.root;
        if (element_is_black(element))
            continue;
        list.items[list.count++] =
            (struct sample){.area = element_area(element, scene),
                            .value =
                                reflected(scene, root,
                                          render_point(renderer, root, element->weight,
                                                       (uint64_t)i)),
                            .truth = {element->point[0], element->point[1]}};
    }
    struct deviation deviation = deviation_of(list.items, list.count);
    alloc_free(list.items);
    return deviation;
}
