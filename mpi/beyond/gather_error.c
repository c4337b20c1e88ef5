/* Errors of a final gather, leaf by leaf.
 *
 * A row sees each leaf by its mean, while B varies over the leaf; and a row has some rays
 * chosen among many. The variances of both add up: each leaf's H, times rho, is off by
 * their root. The first is taken from how B varies in the parent, the second from the
 * scatter of the light of single rays. The part of B missing from the solution comes on
 * top: a furnace, whose rows are exact, has no other error. */
#include "mpi/beyond/gathering.h"

#include <math.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "mpi/beyond/beyond.h"

/* The light of an undivided root varies by about the first part, or the second times its
 * size over its distance: seen from near, a root may be lit unlike its mean. */
static const double UNDIVIDED = 0.2, UNDIVIDED_NEAR = 0.3;

/* The error of 95 % of leaves is less than this many deviations: these are estimated for
 * many leaves together, and single ones are noisier or calmer. */
static const double BOUND = 2.5;

/* Factors of lamps, by few points of a leaf, deviate by about this part. */
static const double FACTORS = 4e-4;

/* Classes of leaves by their light: the last has 2^(BRIGHTEST - 1) times the mean and
 * more. Fewest leaves, counted in each band, to estimate a ratio over. */
enum { CLASSES = 48, BRIGHTEST = 8, FEWEST = 128 };

/* An estimate of how B varies within a leaf as seen from a point: half of its difference
 * from the mean over its parent; of undivided roots, a part of the reflected
 * radiosity. */
static struct rgb variation_of(const struct gathering *g, int64_t place, struct vec3 from)
{
    const struct forest *forest = g->solver->model.forest;
    int32_t patch = g->gather->order[place], parent = forest->patches[patch].parent;
    struct rgb base = parent >= 0 ? g->radiosity[g->gather->place[parent]]
                                  : forest_material(forest, patch)->emission;
    struct rgb deviation = rgb_sub(g->radiosity[place], base);
    double part = 0.5;
    if (parent < 0) {
        struct vec3 apart = vec3_sub(g->gather->near->leaves[patch].middle, from);
        double near = sqrt(forest_area(forest, patch) / vec3_dot(apart, apart));
        part = fmin(1.0, fmax(UNDIVIDED, UNDIVIDED_NEAR * near));
    }
    for (int c = 0; c < BANDS; c++)
        deviation.band[c] *= part;
    return deviation;
}

/* Collective. Variance of H from factors of lamps, and from B varying within leaves seen
 * by rows, (W/m^2)^2. B varies independently in different leaves, so their errors add up
 * as variances. Pre: g->radiosity is the solution. */
static void variances_by_mesh(struct gathering *g, struct rgb *variance)
{
    const struct final_gather *gather = g->gather;
    struct rgb *own = g->all + g->stages->at[g->solver->comm->rank];
    for (int64_t row = 0, k = 0; row < gather->count; row++) {
        struct vec3 from = gather->near->leaves[gather->rows[row].leaf].middle;
        for (int c = 0; c < BANDS; c++) {
            double off = FACTORS * gather->rows[row].lamps.band[c];
            own[row].band[c] = off * off;
        }
        for (; k < gather->rows[row].end; k++) {
            struct rgb deviation = variation_of(g, gather->terms[k].place, from);
            for (int c = 0; c < BANDS; c++) {
                double h = (double)gather->terms[k].weight[c] * deviation.band[c];
                own[row].band[c] += h * h;
            }
        }
    }
    gathering_share_rows(g, variance);
}

/* A leaf whose rays have missed a small bright thing found by one of its sisters is too
 * dark, with too small a variance as well: the leaf gets the mean of the sisters', each
 * of one ray, where larger. `rays`: of each leaf; or segments. */
static void raise_to_sisters(const struct gathering *g, const int *rays,
                             struct rgb *variance)
{
    const struct patch *patches = g->solver->model.forest->patches;
    size_t count = (size_t)g->solver->model.forest->count;
    struct rgb *sums = alloc_array(count, sizeof *sums);
    uint8_t *sisters = alloc_array(count, sizeof *sisters);
    for (int raises = 0; raises < 2; raises++)
        for (int64_t i = 0; i < g->count; i++) {
            int32_t parent = patches[g->leaves[i]].parent;
            if (parent < 0)
                continue;
            double *v = variance[i].band;
            sisters[parent] = (uint8_t)(sisters[parent] + !raises);
            for (int c = 0; c < BANDS; c++)
                if (raises)
                    v[c] = fmax(v[c], sums[parent].band[c] / (sisters[parent] * rays[i]));
                else
                    sums[parent].band[c] += rays[i] * v[c];
        }
    alloc_free(sisters);
    alloc_free(sums);
}

/* Variances of a class of leaves, summed up, each times its leaf's area. */
struct noise {
    double by_halves, by_chance;
    int64_t count;
};

/* The class of a leaf by its H in a band. Each has twice the light of the one before. */
static int class_of(double light, double mean)
{
    int exponent = 0;
    if (!(light > 0.0 && mean > 0.0))
        return 0;
    frexp(light / mean, &exponent);
    int place = CLASSES - 1 - BRIGHTEST + exponent;
    return place < 0 ? 0 : place < CLASSES ? place : CLASSES - 1;
}

/* A leaf's H in a band, W/m^2; 0 if the leaf reflects none. */
static double irradiance_of(const struct gathering *g, int64_t leaf, int band)
{
    const struct material *m = gathering_material(g, leaf);
    double rho = m->reflectance.band[band];
    double b = g->radiosity[g->gather->place[g->leaves[leaf]]].band[band];
    return rho > 0.0 ? fmax(0.0, (b - m->emission.band[band]) / rho) : 0.0;
}

/* Adds each leaf, a band at a time, to a class, whose number `own`, [BANDS * count],
 * tells. Leaves count by their area and the square of their reflectance. */
static void classify(const struct gathering *g, const struct rgb *halves,
                     const struct rgb *chance, struct noise *classes, uint8_t *own)
{
    double *light = alloc_array(BANDS * (size_t)g->count, sizeof *light);
    double *weight = alloc_array(BANDS * (size_t)g->count, sizeof *weight);
    double sum = 0.0, all = 0.0;
    for (int64_t k = 0; k < BANDS * g->count; k++) {
        int64_t i = k / BANDS;
        double rho = gathering_material(g, i)->reflectance.band[k % BANDS];
        light[k] = irradiance_of(g, i, (int)(k % BANDS));
        weight[k] = g->areas[i] * rho * rho;
        sum += weight[k] * light[k];
        all += weight[k];
    }
    for (int64_t k = 0; k < BANDS * g->count; k++) {
        own[k] = (uint8_t)class_of(light[k], sum / all);
        struct noise *class = &classes[own[k]];
        class->by_halves += weight[k] * halves[k / BANDS].band[k % BANDS];
        class->by_chance += weight[k] * chance[k / BANDS].band[k % BANDS];
        class->count += weight[k] > 0.0;
    }
    alloc_free(weight);
    alloc_free(light);
}

/* The ratio of the sequence's variance to the one by chance, of reflected light, by the
 * variances of the leaves of a class by their halves and by chance, and of the next
 * classes while leaves are few. A quarter of the squared difference of two halves is the
 * variance of their mean if the two are independent, as if by chance, where the ratio is
 * 1. Of a sequence the second half falls into the gaps of the first: where variance falls
 * threefold with twice the rays, as in the Cornell box and in rooms, the variance is half
 * of that. There the ratio is small, but not where a few rays bring most light, as in a
 * storey below a stairwell. */
static double ratio_of_sequence(const struct noise *classes, int class)
{
    struct noise all = {0};
    for (int width = 0; all.count < FEWEST && width < CLASSES; width++)
        for (int k = class - width; k <= class + width; k += width ? 2 * width : 1) {
            if (k < 0 || k >= CLASSES)
                continue;
            all.by_halves += classes[k].by_halves;
            all.by_chance += classes[k].by_chance;
            all.count += classes[k].count;
        }
    double ratio = all.by_chance > 0.0 ? fmin(1.0, all.by_halves / all.by_chance) : 1.0;
    return ratio / (2.0 - ratio);
}

/* Collective. Variance of H from the choice of rays: the variance by chance, times the
 * sequence's ratio, estimated over all leaves with about as much light. */
static void variances_by_rays(struct gathering *g, struct rgb *variance)
{
    const size_t bytes = sizeof *variance;
    struct rgb *halves = alloc_array((size_t)g->count, bytes);
    struct rgb *lamps = alloc_array((size_t)g->count, bytes);
    gathering_share_field(g, offsetof(struct gather_row, chance), bytes, variance);
    gathering_share_field(g, offsetof(struct gather_row, halves), bytes, halves);
    gathering_share_field(g, offsetof(struct gather_row, of_segments), bytes, lamps);
    struct noise classes[CLASSES] = {{0}};
    double ratios[CLASSES];
    uint8_t *own_class = alloc_array(BANDS * (size_t)g->count, sizeof *own_class);
    classify(g, halves, variance, classes, own_class);
    for (int k = 0; k < CLASSES; k++)
        ratios[k] = ratio_of_sequence(classes, k);
    for (int64_t i = 0; i < g->count; i++)
        variance[i] = rgb_sub(variance[i], lamps[i]);
    raise_to_sisters(g, g->mesh->rays, variance);
    raise_to_sisters(g, g->mesh->segments, lamps);
    for (int64_t i = 0; i < g->count; i++)
        rgb_add(&variance[i], 1.0, lamps[i]);
    for (int64_t k = 0; k < BANDS * g->count; k++)
        variance[k / BANDS].band[k % BANDS] *= ratios[own_class[k]];
    alloc_free(own_class);
    alloc_free(lamps);
    alloc_free(halves);
}

/* A leaf's error relative to its own light. */
struct own_error {
    double relative, area;
};

/* A compare function of qsort(); equal errors may change places. */
static int compare_errors(const void *left, const void *right)
{
    const struct own_error *a = left, *b = right;
    return (a->relative > b->relative) - (a->relative < b->relative);
}

/* Finds percentiles, by area, of the errors of leaves relative to their own light. */
static void rank_errors(struct own_error *errors, int64_t count, struct gathered *counts)
{
    double area = 0.0, passed = 0.0;
    for (int64_t k = 0; k < count; k++)
        area += errors[k].area;
    qsort(errors, (size_t)count, sizeof *errors, compare_errors);
    for (int64_t k = 0; k < count; k++) {
        if (passed <= 0.5 * area)
            counts->median = errors[k].relative;
        if (passed <= 0.9 * area)
            counts->worst_tenth = errors[k].relative;
        passed += errors[k].area;
    }
}

void gathering_estimate_errors(struct gathering *g, double remaining)
{
    struct solver *solver = g->solver;
    size_t count = (size_t)g->count;
    struct rgb *mesh = alloc_array(count, sizeof *mesh);
    struct rgb *rays = alloc_array(count, sizeof *rays);
    struct own_error *errors = alloc_array(count, sizeof *errors);
    int64_t listed = 0;
    double by_rays = 0.0, by_mesh = 0.0, light = 0.0;
    variances_by_mesh(g, mesh);
    variances_by_rays(g, rays);
    alloc_free(solver->beyond->answer->error);
    float *error = alloc_array((size_t)solver->model.forest->count, sizeof *error);
    solver->beyond->answer->error = error;
    for (int64_t i = 0; i < g->count; i++) {
        const struct material *m = gathering_material(g, i);
        struct rgb b = g->radiosity[g->gather->place[g->leaves[i]]];
        double largest = 0.0, square = 0.0, own = 0.0;
        for (int c = 0; c < BANDS; c++) {
            double rho = m->reflectance.band[c], h = irradiance_of(g, i, c);
            double deviation = rho * sqrt(mesh[i].band[c] + rays[i].band[c]);
            double reflected = b.band[c] - m->emission.band[c];
            double lacks = remaining * b.band[c];
            largest = fmax(largest,
                           BOUND * sqrt(deviation * deviation + lacks * lacks));
            by_rays += g->areas[i] * rho * rho * rays[i].band[c];
            by_mesh += g->areas[i] * rho * rho * mesh[i].band[c];
            light += g->areas[i] * reflected * reflected;
            square += rho * rho * (rays[i].band[c] + mesh[i].band[c]);
            own += rho * rho * h * h;
        }
        error[g->leaves[i]] = (float)largest;
        if (square + own > 0.0)
            errors[listed++] = (struct own_error){
                fmin(1.0, sqrt(square / own + remaining * remaining)), g->areas[i]};
    }
    rank_errors(errors, listed, &solver->beyond->answer->counts);
    if (light > 0.0) {
        solver->beyond->answer->counts.by_rays = sqrt(by_rays / light);
        solver->beyond->answer->counts.by_mesh = sqrt(by_mesh / light);
        solver->beyond->answer->counts.error =
            sqrt((by_rays + by_mesh) / light + remaining * remaining);
    }
    alloc_free(errors);
    alloc_free(rays);
    alloc_free(mesh);
}
