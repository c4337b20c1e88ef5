/* Conjugate gradients.
 *
 * F maps radiosities of leaves to irradiances; A F is symmetric, since links are. With
 * the caps F' = d F, d the factor of a leaf's irradiance, and with the scalar product
 *
 *     <x, y> = sum over leaves of w x y,   w = A rho / d,
 *
 * K = 1 - F' rho is self-adjoint, and positive where row sums times rho are below 1: w F'
 * rho = rho (A F) rho. So conjugate gradients apply to K as it stands, without square
 * roots of rho, and surfaces that reflect nothing take no part: their w is 0. The three
 * bands are three systems, solved side by side.
 *
 * In the form of Chronopoulos and Gear one step costs one transfer of light and two sums
 * of a few numbers over all ranks: with w = K z, gamma = <z, z>, delta = <w, z>,
 *
 *     turn = gamma / gamma_before,     step = gamma / (delta - turn gamma / step_before),
 *     p = z + turn p,    K p = w + turn K p,    H += step p,    z -= step K p.
 *
 * Products are summed as integers in a unit that is chosen from bounds on their factors,
 * so they are the same on any number of ranks, and so is every bit of the result.
 * Jacobi's method, the paper's, gains a factor rho per iteration; this one needs some ten
 * iterations for any rho. */
#include "rad/beyond/conjugate.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/pushpull.h"

void conjugate_free(struct conjugate *cg)
{
    alloc_free(cg->irradiance);
    alloc_free(cg->residual);
    alloc_free(cg->work);
    alloc_free(cg->direction);
    alloc_free(cg->image);
    alloc_free(cg->sent);
    alloc_free(cg->leaves);
    *cg = (struct conjugate){0};
}

void conjugate_extend(struct conjugate *cg, const struct forest *forest, const bool *own)
{
    struct rgb **vectors[6] = {&cg->irradiance, &cg->residual, &cg->work, &cg->direction,
                               &cg->image, &cg->sent};
    for (int i = 0; i < 6; i++)
        RESERVE(*vectors[i], &cg->capacity[i], forest->count);
    for (int64_t p = cg->count; p < forest->count; p++) {
        int32_t parent = forest->patches[p].parent;
        cg->irradiance[p] =
            parent >= 0 ? cg->irradiance[parent] : (struct rgb){{0.0, 0.0, 0.0}};
        cg->sent[p] = (struct rgb){{0.0, 0.0, 0.0}};
    }
    cg->count = forest->count;
    cg->leaf_count = 0;
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        if (!own[patch->id.root] || !patch_is_leaf(patch) ||
            scene_root_area(forest->scene, (int32_t)patch->id.root) <= 0.0)
            continue;
        RESERVE(cg->leaves, &cg->leaf_capacity, cg->leaf_count + 1);
        cg->leaves[cg->leaf_count++] = (int32_t)p;
    }
}

struct flux_unit conjugate_unit(const struct model *model, double a, double b,
                                double weight)
{
    return flux_unit_for(fmax(a * b * weight * model->area, 1e-250));
}

void conjugate_start(struct conjugate *cg, const struct model *model,
                     const struct caps *caps, struct flux_unit flux)
{
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        int32_t leaf = cg->leaves[i];
        const struct material *material = forest_material(model->forest, leaf);
        struct rgb h = leaf_irradiance(model->forest, leaf, flux);
        for (int c = 0; c < BANDS; c++) {
            double now = caps->factor[leaf] * h.band[c];
            if (material->reflectance.band[c] == 0.0)
                cg->irradiance[leaf].band[c] = now;
            cg->residual[leaf].band[c] = now - cg->irradiance[leaf].band[c];
            cg->direction[leaf].band[c] = cg->image[leaf].band[c] = 0.0;
        }
    }
}

void conjugate_apply(struct conjugate *cg, const struct model *model,
                     const struct caps *caps, struct flux_unit flux,
                     struct flux_unit unit, int64_t product[BANDS])
{
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        int32_t leaf = cg->leaves[i];
        const struct material *material = forest_material(model->forest, leaf);
        struct rgb h = leaf_irradiance(model->forest, leaf, flux);
        double weight = forest_area(model->forest, leaf) / caps->factor[leaf];
        for (int c = 0; c < BANDS; c++) {
            double z = cg->residual[leaf].band[c];
            double w = z - caps->factor[leaf] * h.band[c];
            cg->work[leaf].band[c] = w;
            double term = weight * material->reflectance.band[c] * (w * z);
            product[c] = flux_add(product[c], flux_from_watts(unit, term));
        }
    }
}

void conjugate_advance(struct conjugate *cg, const struct model *model,
                       const double turn[BANDS], const double step[BANDS])
{
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        int32_t p = cg->leaves[i];
        const struct material *material = forest_material(model->forest, p);
        for (int c = 0; c < BANDS; c++) {
            double *direction = &cg->direction[p].band[c], *image = &cg->image[p].band[c];
            *image = cg->work[p].band[c] + turn[c] * *image;
            if (material->reflectance.band[c] == 0.0) { /* p = z = 0, H follows */
                cg->irradiance[p].band[c] -= step[c] * *image;
                continue;
            }
            *direction = cg->residual[p].band[c] + turn[c] * *direction;
            cg->irradiance[p].band[c] += step[c] * *direction;
            cg->residual[p].band[c] -= step[c] * *image;
        }
    }
}

void conjugate_send(struct conjugate *cg, const struct model *model)
{
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        int32_t p = cg->leaves[i];
        const struct material *material = forest_material(model->forest, p);
        for (int c = 0; c < BANDS; c++)
            cg->sent[p].band[c] =
                material->reflectance.band[c] * cg->residual[p].band[c];
    }
}

void conjugate_finish(const struct conjugate *cg, struct model *model)
{
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        int32_t p = cg->leaves[i];
        const struct material *material = forest_material(model->forest, p);
        for (int c = 0; c < BANDS; c++)
            model->forest->radiosity[p].band[c] =
                material->emission.band[c] +
                material->reflectance.band[c] * cg->irradiance[p].band[c];
    }
}

struct conjugate_sums conjugate_sum(const struct conjugate *cg, const struct model *model,
                                    const struct caps *caps, struct flux_unit unit)
{
    struct conjugate_sums sums = {0};
    struct flux_unit watt = model->flux_unit;
    for (int64_t i = 0; i < cg->leaf_count; i++) {
        int32_t leaf = cg->leaves[i];
        const struct material *material = forest_material(model->forest, leaf);
        double area = forest_area(model->forest, leaf);
        double weight = area / caps->factor[leaf];
        double light = 0.0, absorbed = 0.0, arriving = 0.0, negative = 0.0, missing = 0.0;
        for (int c = 0; c < BANDS; c++) {
            double rho = material->reflectance.band[c], h = cg->irradiance[leaf].band[c];
            double z = cg->residual[leaf].band[c];
            light += area * (material->emission.band[c] + rho * h);
            absorbed += area * ((1.0 - rho) * h);
            arriving += area * (h + z);
            negative += area * (rho * fmax(0.0, -h));
            missing += weight * fabs(z);
            sums.square[c] = flux_add(sums.square[c],
                                      flux_from_watts(unit, weight * rho * (z * z)));
            sums.largest = fmax(sums.largest, rho > 0.0 ? fabs(z) : 0.0);
        }
        double most = fmax(fabs(light), fmax(fabs(absorbed), fabs(arriving)));
        sums.light = flux_add(sums.light, flux_from_watts(watt, light));
        sums.absorbed = flux_add(sums.absorbed, flux_from_watts(watt, absorbed));
        sums.arriving = flux_add(sums.arriving, flux_from_watts(watt, arriving));
        sums.bulk = flux_add(sums.bulk, flux_from_watts(watt, most));
        sums.negative = flux_add(sums.negative, flux_from_watts(watt, negative));
        sums.missing = flux_add(sums.missing, flux_from_watts(watt, missing));
    }
    return sums;
}
