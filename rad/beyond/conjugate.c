/* Conjugate residuals (Stiefel, 1955).
 *
 * An iteration makes G(B) = E + rho d F B of the light B, with d the caps. Its residual
 * r = G(B) - B is to vanish. K = 1 - rho d F is self-adjoint with the scalar product
 *
 *     <x, y> = sum over leaves of w x y,   w = A / (rho d),
 *
 * for w rho d F = A F, which is symmetric since links are. So the change of B along all
 * residuals so far that leaves the least <r, r> is found from the last direction alone:
 *
 *     p = r + turn p,   K p = K r + turn K p,   turn = - <K r, K p> / <K p, K p>,
 *     B += step p,      r -= step K p,          step = <r, K p> / <K p, K p>.
 *
 * The next iteration, if of B + r, tells K r: G(B + r) - (B + r) = r - K r. So ranks
 * exchange the light, as in the paper's method, and sums; each has the vectors of its own
 * leaves. Bands are three systems side by side; surfaces reflecting nothing have no
 * residual.
 *
 * The error e of B solves K e = r, so it is r + rho d F r + (rho d F)^2 r + ... Let |x|
 * be the sum of w |x| over leaves and bands. A F being symmetric, |rho d F x| is at most
 * q |x|, with q the largest row sum times rho d. Caps keep q below 1. So |e| is at most
 * |r| / (1 - q), the error of G(B) q times as much, and the light missing there at most
 * the largest rho d times that.
 *
 * Jacobi's method, the paper's, gains a factor rho per iteration; this one needs some ten
 * iterations for any rho. */
#include "rad/beyond/conjugate.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/pushpull.h"

void conjugate_free(struct conjugate *cg)
{
    alloc_free(cg->leaves);
    alloc_free(cg->weight);
    alloc_free(cg->radiosity);
    alloc_free(cg->residual);
    alloc_free(cg->direction);
    alloc_free(cg->image);
    alloc_free(cg->terms);
    *cg = (struct conjugate){0};
}

/* Row sum times reflectance is the factor of light's growth from bounce to bounce, kept
 * at or below half way from rho to 1. A lower limit took light from leaves close to
 * lamps, which have links of many levels. */
static double cap_of(double reflectance, double row)
{
    double most = 0.5 * (1.0 + reflectance);
    return reflectance * row > most ? most / (reflectance * row) : 1.0;
}

/* Chooses the cap of a leaf, and lists a reflecting leaf. */
static void add_leaf(struct conjugate *cg, struct forest *forest, int32_t leaf,
                     double row)
{
    struct rgb rho = forest_material(forest, leaf)->reflectance;
    double largest = rgb_most(rho);
    double reflected = largest * cap_of(largest, row);
    forest->caps[leaf] = cap_of(largest, row);
    if (!(largest > 0.0))
        return;
    cg->growth = fmax(cg->growth, row * reflected);
    cg->share = fmax(cg->share, reflected);
    cg->leaves[cg->count++] = leaf;
}

static struct rgb weight_of(const struct forest *forest, int32_t leaf)
{
    struct rgb rho = forest_material(forest, leaf)->reflectance, w;
    double area = forest_area(forest, leaf);
    for (int c = 0; c < BANDS; c++)
        w.band[c] = rho.band[c] > 0.0 ? area / (rho.band[c] * forest->caps[leaf]) : 0.0;
    return w;
}

void conjugate_begin(struct conjugate *cg, struct forest *forest, const bool *own,
                     struct flux_unit unit, struct totals totals)
{
    conjugate_free(cg);
    alloc_free(forest->caps);
    forest->caps = alloc_array((size_t)forest->count, sizeof *forest->caps);
    cg->totals = totals;
    cg->leaves = alloc_array((size_t)forest->count, sizeof *cg->leaves);
    for (int32_t p = 0; p < forest->count; p++) {
        int32_t root = (int32_t)forest->patches[p].id.root;
        if (own[root] && patch_is_leaf(&forest->patches[p]) &&
            scene_root_area(forest->scene, root) > 0.0)
            add_leaf(cg, forest, p, leaf_irradiance(forest, p, unit).band[0]);
    }
    double most[2] = {cg->growth, cg->share};
    totals.largest(totals.context, most, 2);
    cg->growth = most[0];
    cg->share = most[1];
    size_t count = (size_t)cg->count;
    cg->weight = alloc_array(count, sizeof *cg->weight);
    cg->radiosity = alloc_array(count, sizeof *cg->radiosity);
    cg->residual = alloc_array(count, sizeof *cg->residual);
    cg->direction = alloc_array(count, sizeof *cg->direction);
    cg->image = alloc_array(count, sizeof *cg->image);
    cg->terms = alloc_array(2 * BANDS * count, sizeof *cg->terms);
    for (int64_t i = 0; i < cg->count; i++) {
        cg->weight[i] = weight_of(forest, cg->leaves[i]);
        cg->radiosity[i] = forest->radiosity[cg->leaves[i]];
    }
}

/* The residual of B + r, the light of the iteration. */
static double change(const struct conjugate *cg, const struct forest *forest, int64_t i,
                     int c)
{
    return forest->radiosity[cg->leaves[i]].band[c] -
           (cg->radiosity[i].band[c] + cg->residual[i].band[c]);
}

double conjugate_missing(const struct conjugate *cg, const struct forest *forest,
                         const struct spaces *spaces)
{
    double sum;
    for (int64_t i = 0; i < cg->count; i++) {
        uint32_t root = forest->patches[cg->leaves[i]].id.root;
        double dimness = space_dimness(spaces, root);
        cg->terms[i] = 0.0;
        for (int c = 0; c < BANDS; c++)
            cg->terms[i] +=
                dimness * (cg->weight[i].band[c] * fabs(change(cg, forest, i, c)));
    }
    total_up(&cg->totals, cg->terms, cg->count, 1, &sum);
    return cg->share * cg->growth / (1.0 - cg->growth) * sum;
}

/* <x, K p> / <K p, K p> of each band, where x is r, or K r if `image`; 0 if K p is 0, as
 * of a solved system. */
static struct rgb quotients(const struct conjugate *cg, const struct forest *forest,
                            bool image)
{
    double sums[2 * BANDS];
    struct rgb quotients = {{0.0, 0.0, 0.0}};
    for (int64_t i = 0; i < cg->count; i++)
        for (int c = 0; c < BANDS; c++) {
            double w = cg->weight[i].band[c], kp = cg->image[i].band[c];
            double x = cg->residual[i].band[c] - (image ? change(cg, forest, i, c) : 0.0);
            cg->terms[2 * (BANDS * i + c)] = w * (x * kp);
            cg->terms[2 * (BANDS * i + c) + 1] = w * (kp * kp);
        }
    total_up(&cg->totals, cg->terms, cg->count, 2 * BANDS, sums);
    for (int c = 0; c < BANDS; c++)
        if (sums[2 * c + 1] > 0.0)
            quotients.band[c] = sums[2 * c] / sums[2 * c + 1];
    return quotients;
}

/* p = r + turn p, K p = K r + turn K p. */
static void turn(struct conjugate *cg, const struct forest *forest)
{
    struct rgb minus = quotients(cg, forest, true);
    for (int64_t i = 0; i < cg->count; i++)
        for (int c = 0; c < BANDS; c++) {
            double *p = &cg->direction[i].band[c], *image = &cg->image[i].band[c];
            double r = cg->residual[i].band[c];
            *p = r - minus.band[c] * *p;
            *image = r - change(cg, forest, i, c) - minus.band[c] * *image;
        }
}

/* B += step p, r -= step K p. */
static void advance(struct conjugate *cg, const struct forest *forest)
{
    struct rgb step = quotients(cg, forest, false);
    for (int64_t i = 0; i < cg->count; i++)
        for (int c = 0; c < BANDS; c++) {
            cg->radiosity[i].band[c] += step.band[c] * cg->direction[i].band[c];
            cg->residual[i].band[c] -= step.band[c] * cg->image[i].band[c];
        }
}

void conjugate_step(struct conjugate *cg, struct forest *forest)
{
    if (cg->begun) {
        turn(cg, forest);
        advance(cg, forest);
    }
    for (int64_t i = 0; i < cg->count; i++)
        for (int c = 0; c < BANDS; c++) {
            double *b = &forest->radiosity[cg->leaves[i]].band[c];
            if (!cg->begun)
                cg->residual[i].band[c] = *b - cg->radiosity[i].band[c];
            *b = cg->radiosity[i].band[c] + cg->residual[i].band[c];
        }
    cg->begun = true;
}
