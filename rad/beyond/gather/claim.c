/* Errors of a final gather, leaf by leaf.
 *
 * A row sees each leaf by its mean, while B varies over the leaf; and a row has some rays
 * chosen among many. The variances of both add up: each leaf's H, times rho, is off by
 * their root. The first is taken from how B varies in the parent, the second from the
 * scatter of the light of single rays. The part of B missing from the solution comes on
 * top: a furnace, whose rows are exact, has no other error. */
#include "rad/beyond/gather/claim.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/flux.h"

/* The light of an undivided root varies by about this part times its size over its
 * distance: seen from near, a root may be lit unlike its mean. */
static const double UNDIVIDED = 0.3;

/* The error of 95 % of leaves is less than this many deviations: these are estimated for
 * many leaves together, and single ones are noisier or calmer. */
static const double BOUND = 2.5;

/* Factors of lamps, by few points of a leaf, deviate by about this part. */
static const double FACTORS = 4e-4;

/* Classes of the leaves of a space by their light: the last has 2^(BRIGHTEST - 1) times
 * the mean and more. */
enum { CLASSES = 48, BRIGHTEST = 8 };

/* An estimate of how B varies within a leaf as seen from a point: half of its difference
 * from the mean over its parent; of undivided roots, a part of the reflected
 * radiosity. */
static struct rgb variation_of(const struct equation *e, int64_t place, struct vec3 from)
{
    const struct forest *forest = e->gather->model->forest;
    int32_t patch = e->gather->order[place], parent = forest->patches[patch].parent;
    struct rgb base = parent >= 0 ? e->radiosity[e->gather->place[parent]]
                                  : forest_material(forest, patch)->emission;
    double part = 0.5;
    if (parent < 0) {
        struct vec3 apart = vec3_sub(e->gather->near->leaves[patch].middle, from);
        double near = sqrt(forest_area(forest, patch) / vec3_dot(apart, apart));
        part = fmin(1.0, UNDIVIDED * near);
    }
    return rgb_scale(rgb_sub(e->radiosity[place], base), part);
}

void claim_by_mesh(const struct equation *e, struct rgb *variance)
{
    const struct final_gather *gather = e->gather;
    for (int64_t row = 0, k = 0; row < gather->count; row++) {
        struct vec3 from = gather->near->leaves[gather->rows[row].leaf].middle;
        for (int c = 0; c < BANDS; c++) {
            double off = FACTORS * gather->rows[row].straight.band[c];
            variance[row].band[c] = off * off;
        }
        for (; k < gather->rows[row].end; k++) {
            struct rgb deviation = variation_of(e, gather->terms[k].place, from);
            for (int c = 0; c < BANDS; c++) {
                double h = (double)gather->terms[k].weight[c] * deviation.band[c];
                variance[row].band[c] += h * h;
            }
        }
    }
}

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
static double irradiance_of(const struct equation *e, int64_t leaf, int band)
{
    const struct material *m = equation_material(e, leaf);
    double rho = m->reflectance.band[band];
    double b = e->radiosity[equation_place(e, leaf)].band[band];
    return rho > 0.0 ? fmax(0.0, (b - m->emission.band[band]) / rho) : 0.0;
}

/* Variances of a class of leaves, summed up, each times its leaf's weight. */
struct noise {
    double by_halves, by_chance;
};

/* Collective. Sums up the noise of each class, [CLASSES * lit_count()]. In each band a
 * leaf is in one class of its space; `own`, [BANDS * count], gets the number of that
 * class. A leaf counts by its area times the square of its reflectance. */
static void classify(const struct equation *e, struct noise *classes, int32_t *own)
{
    const struct gather_row *rows = e->gather->rows;
    enum { COLUMNS = sizeof *classes / sizeof(double) };
    int32_t spaces = lit_count(e->gather->model);
    int64_t all = BANDS * e->count;
    double *light = alloc_array((size_t)all, sizeof *light);
    double *terms = alloc_array(COLUMNS * (size_t)all, sizeof *terms);
    double *sums = alloc_array(2 * (size_t)spaces, sizeof *sums);
    for (int64_t k = 0; k < all; k++) {
        int64_t i = k / BANDS;
        double rho = equation_material(e, i)->reflectance.band[k % BANDS];
        own[k] = e->space[i];
        light[k] = irradiance_of(e, i, (int)(k % BANDS));
        terms[2 * k + 1] = e->areas[i] * rho * rho;
        terms[2 * k] = terms[2 * k + 1] * light[k];
    }
    total_groups(&e->totals, terms, own, all, spaces, 2, sums);
    for (int64_t k = 0; k < all; k++) {
        int64_t i = k / BANDS;
        const double *sum = &sums[2 * own[k]];
        double rho = equation_material(e, i)->reflectance.band[k % BANDS];
        double weight = e->areas[i] * rho * rho;
        own[k] = CLASSES * own[k] + class_of(light[k], sum[0] / sum[1]);
        terms[COLUMNS * k] = weight * rows[i].halves.band[k % BANDS];
        terms[COLUMNS * k + 1] = weight * rows[i].chance.band[k % BANDS];
    }
    total_groups(&e->totals, terms, own, all, CLASSES * spaces, COLUMNS,
                 (double *)classes);
    alloc_free(sums);
    alloc_free(terms);
    alloc_free(light);
}

/* The ratio of the sequence's variance to that by chance, for a class of leaves. A
 * quarter of the squared difference of two halves is the variance of their mean if the
 * halves are independent. Let q be this variance over the one by chance: 1 for
 * independent halves. But the second half of a sequence falls into the gaps of the first.
 * Where twice the rays leave a third of the variance, as in the Cornell box and in rooms,
 * the mean has half of what its halves tell. So the ratio is q / (2 - q). Below a
 * stairwell, where a few rays bring most light, it is near 1. */
static double ratio_of_sequence(const struct noise *class)
{
    double ratio =
        class->by_chance > 0.0 ? fmin(1.0, class->by_halves / class->by_chance) : 1.0;
    return ratio / (2.0 - ratio);
}

void claim_by_rays(const struct equation *e, struct rgb *variance)
{
    int32_t all = CLASSES * lit_count(e->gather->model);
    struct noise *classes = alloc_array((size_t)all, sizeof *classes);
    double *ratios = alloc_array((size_t)all, sizeof *ratios);
    int32_t *own_class = alloc_array(BANDS * (size_t)e->count, sizeof *own_class);
    classify(e, classes, own_class);
    for (int32_t k = 0; k < all; k++)
        ratios[k] = ratio_of_sequence(&classes[k]);
    for (int64_t k = 0; k < BANDS * e->count; k++)
        variance[k / BANDS].band[k % BANDS] =
            ratios[own_class[k]] * e->gather->rows[k / BANDS].chance.band[k % BANDS];
    alloc_free(own_class);
    alloc_free(ratios);
    alloc_free(classes);
}

/* Sums over the reflecting leaves of a space, but the first by area, (W/m^2)^2. */
struct space_error {
    double leaves, by_rays, by_mesh, light;
};

/* The part of B that the light of a space may be off by in the end. */
static double lacking_of(const struct light_balance *balance, int32_t space,
                         double remaining)
{
    return remaining + balance->flows[balance->apart ? space : 0].unsure;
}

/* Sums up the errors of spaces: each counts by its leaves, relative to its own light. */
static void sum_errors(const struct light_balance *balance, double remaining,
                       const struct space_error *spaces, struct gathered *told)
{
    int32_t count = lit_count(balance->equation->gather->model);
    double leaves = 0.0, by_rays = 0.0, by_mesh = 0.0, all = 0.0;
    for (int32_t s = 0; s < count; s++)
        leaves += spaces[s].leaves;
    for (int32_t s = 0; s < count; s++) {
        if (!(spaces[s].light > 0.0))
            continue;
        double part = spaces[s].leaves / leaves;
        double lacking = lacking_of(balance, s, remaining);
        by_rays += part * (spaces[s].by_rays / spaces[s].light);
        by_mesh += part * (spaces[s].by_mesh / spaces[s].light);
        all += part * ((spaces[s].by_rays + spaces[s].by_mesh) / spaces[s].light +
                       lacking * lacking);
    }
    told->by_rays = sqrt(by_rays);
    told->by_mesh = sqrt(by_mesh);
    told->error = sqrt(all);
}

/* The error that a part of the leaves exceeds, by their deviations, is searched for. */
struct quantile {
    const double *deviations; /* [count] */
    double part;
    double low, high;         /* bounds on the error */
};

/* The sum over leaves of the chance that their light is off by more than `limit`, with
 * these deviations, in the same unit: errors are normal (Abramowitz and Stegun, 26.2.18,
 * to 2.5e-4). */
static int64_t chance_beyond(const double *deviations, int64_t count, double limit,
                             struct flux_unit unit)
{
    int64_t sum = 0; /* of chances in (0, 1] */
    for (int64_t k = 0; k < count; k++) {
        double x = limit / deviations[k];
        double root = 0.115194 + x * (0.000344 + x * 0.019527);
        root = 1.0 + x * (0.196854 + x * root);
        sum += llrint(unit.per_watt / (root * root * root * root));
    }
    return sum;
}

/* Collective. Finds errors, at most 1, of which there are `count` on this rank. A leaf
 * counts as one: by area a lawn would decide for the rooms of a house. */
static void find_quantiles(const struct totals *totals, struct quantile *quantiles,
                           int64_t count)
{
    enum { HALVINGS = 40, QUANTILES = 4 };
    struct flux_unit unit = flux_unit_for((double)totals->terms);
    int64_t all = count, beyond[QUANTILES];
    totals_add(totals, &all, 1);
    for (int k = 0; k < HALVINGS; k++) {
        for (int q = 0; q < QUANTILES; q++) {
            double middle = 0.5 * (quantiles[q].low + quantiles[q].high);
            beyond[q] = chance_beyond(quantiles[q].deviations, count, middle, unit);
        }
        totals_add(totals, beyond, QUANTILES);
        for (int q = 0; q < QUANTILES; q++) {
            struct quantile *own = &quantiles[q];
            bool more = flux_to_watts(unit, beyond[q]) > own->part * (double)all;
            *(more ? &own->low : &own->high) = 0.5 * (own->low + own->high);
        }
    }
}

double claim_deviation(double error)
{
    return error / BOUND;
}

void claim_errors(const struct light_balance *balance, double remaining,
                  const struct rgb *mesh, const struct rgb *rays, double *error,
                  struct gathered *told)
{
    enum { COLUMNS = sizeof(struct space_error) / sizeof(double) };
    const struct equation *e = balance->equation;
    size_t count = (size_t)e->count, spaces = (size_t)lit_count(e->gather->model);
    double *own_errors = alloc_array(3 * count, sizeof *own_errors);
    double *all = own_errors, *by_rays = all + count, *by_mesh = by_rays + count;
    struct space_error *terms = alloc_array(count, sizeof *terms);
    struct space_error *sums = alloc_array(spaces, sizeof *sums);
    int64_t listed = 0;
    for (int64_t i = 0; i < e->count; i++) {
        const struct material *m = equation_material(e, i);
        struct rgb b = e->radiosity[equation_place(e, i)];
        struct space_error *term = &terms[i];
        double own = 0.0, square[2] = {0.0, 0.0};
        double lacking = lacking_of(balance, e->space[i], remaining);
        term->leaves = rgb_sum(m->reflectance) > 0.0;
        error[i] = 0.0;
        for (int c = 0; c < BANDS; c++) {
            double rho = m->reflectance.band[c], h = irradiance_of(e, i, c);
            double deviation = rho * sqrt(mesh[i].band[c] + rays[i].band[c]);
            double reflected = b.band[c] - m->emission.band[c];
            double lacks = lacking * b.band[c];
            error[i] = fmax(error[i],
                            BOUND * sqrt(deviation * deviation + lacks * lacks));
            square[0] += rho * rho * rays[i].band[c];
            square[1] += rho * rho * mesh[i].band[c];
            term->light += e->areas[i] * reflected * reflected;
            own += rho * rho * h * h;
        }
        term->by_rays = e->areas[i] * square[0];
        term->by_mesh = e->areas[i] * square[1];
        bool shown = equation_cover(e, i)->outside > 0.0f; /* nothing hides all of it */
        if (!shown || !(square[0] + square[1] + own > 0.0))
            continue;
        by_rays[listed] = square[0] > 0.0 ? sqrt(square[0] / own) : 0.0;
        by_mesh[listed] = square[1] > 0.0 ? sqrt(square[1] / own) : 0.0;
        all[listed++] = sqrt((square[0] + square[1]) / own + lacking * lacking);
    }
    struct quantile quantiles[] = {{all, 0.5, 0.0, 1.0}, {all, 0.1, 0.0, 1.0},
                                   {by_rays, 0.5, 0.0, 1.0}, {by_mesh, 0.5, 0.0, 1.0}};
    find_quantiles(&e->totals, quantiles, listed);
    told->median = quantiles[0].high;
    told->worst_tenth = quantiles[1].high;
    told->median_by_rays = quantiles[2].high;
    told->median_by_mesh = quantiles[3].high;
    total_groups(&e->totals, (double *)terms, e->space, e->count, (int32_t)spaces,
                 COLUMNS, (double *)sums);
    sum_errors(balance, remaining, sums, told);
    alloc_free(sums);
    alloc_free(terms);
    alloc_free(own_errors);
}
