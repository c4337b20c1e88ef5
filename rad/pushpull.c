/* Push-pull.
 *
 * Push: irradiance goes down, H(child) = H(parent) + Phi(child) / A(child). Since only
 * leaves reflect, each leaf adds up its own line of ancestors, at most 16 terms, from the
 * root down. Pull: B goes up; children have equal areas, so a parent's B is their plain
 * mean. A child is always created after its parent, so one loop downwards over patches in
 * the order of creation meets children before parents, and no recursion is needed. */
#include "rad/pushpull.h"

#include <math.h>

struct rgb leaf_irradiance(const struct forest *forest, int32_t leaf,
                           struct flux_unit unit)
{
    int32_t line[ID_MAX_LEVEL + 1];
    int length = 0;
    for (int32_t p = leaf; p >= 0; p = forest->patches[p].parent)
        line[length++] = p;
    struct rgb irradiance = {{0.0, 0.0, 0.0}};
    if (forest->above)
        irradiance = forest->above[line[length - 1]];
    double area = forest_area(forest, line[length - 1]);
    for (; length > 0; area *= 0.25) {
        int32_t p = line[--length];
        for (int c = 0; c < BANDS; c++)
            irradiance.band[c] += flux_to_watts(unit, forest->patches[p].flux[c]) / area;
    }
    return irradiance;
}

/* Gives a leaf its new radiosity, and adds its share to the sums. */
static void update_leaf(const struct model *model, struct flux_unit flux, int32_t leaf,
                        struct push_pull_sums *sums)
{
    struct rgb *radiosity = &model->forest->radiosity[leaf];
    const struct material *material = forest_material(model->forest, leaf);
    struct rgb irradiance = leaf_irradiance(model->forest, leaf, flux);
    int32_t root = (int32_t)model->forest->patches[leaf].id.root;
    double area = scene_is_sky(model->scene, root) ? 0.0 /* no part of the sums */
                                                   : forest_area(model->forest, leaf);
    double cap = model->forest->caps ? model->forest->caps[leaf] : 1.0;
    double light = 0.0, absorbed = 0.0, arriving = 0.0, change = 0.0;
    for (int c = 0; c < BANDS; c++) {
        double rho = material->reflectance.band[c];
        double h = cap * irradiance.band[c];
        double b = material->emission.band[c] + rho * h;
        light += area * b;
        absorbed += area * ((1.0 - rho) * h);
        arriving += area * h;
        change += area * fabs(b - radiosity->band[c]);
        radiosity->band[c] = b;
    }
    sums->leaves++;
    sums->light = flux_add(sums->light, flux_from_watts(model->flux_unit, light));
    sums->arriving =
        flux_add(sums->arriving, flux_from_watts(model->flux_unit, arriving));
    sums->absorbed =
        flux_add(sums->absorbed, flux_from_watts(model->flux_unit, absorbed));
    sums->change = flux_add(sums->change, flux_from_watts(model->flux_unit, change));
}

void patch_average(const struct forest *forest, int32_t p, struct rgb *vector)
{
    if (patch_is_leaf(&forest->patches[p]))
        return;
    const struct rgb *child = &vector[forest->patches[p].children];
    for (int c = 0; c < BANDS; c++)
        vector[p].band[c] = 0.25 * ((child[0].band[c] + child[1].band[c]) +
                                    (child[2].band[c] + child[3].band[c]));
}

void patches_average(struct forest *forest, const int32_t *patches, int64_t count)
{
    for (int64_t i = count - 1; i >= 0; i--)
        patch_average(forest, patches[i], forest->radiosity);
}

void forest_average(struct forest *forest)
{
    for (int64_t p = forest->count - 1; p >= 0; p--)
        patch_average(forest, (int32_t)p, forest->radiosity);
}

struct push_pull_sums push_pull(const struct model *model, struct flux_unit flux,
                                const int32_t *patches, int64_t count)
{
    struct forest *forest = model->forest;
    struct push_pull_sums sums = {0};
    for (int64_t i = 0; i < count; i++) {
        const struct patch *patch = &forest->patches[patches[i]];
        bool has_area = scene_root_area(model->scene, (int32_t)patch->id.root) > 0.0;
        if (has_area && patch_is_leaf(patch))
            update_leaf(model, flux, patches[i], &sums);
    }
    patches_average(forest, patches, count);
    return sums;
}

struct row_sums row_sums_measure(const struct forest *forest, const bool *own,
                                 struct flux_unit unit)
{
    struct row_sums sums = {.min = HUGE_VAL, .max = -HUGE_VAL};
    struct flux_unit coarse = {unit.per_watt / ROW_SUMS_ROOM, unit.watt * ROW_SUMS_ROOM};
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        double area = forest_area(forest, (int32_t)p);
        if (!own[patch->id.root] || !patch_is_leaf(patch) || area <= 0.0 ||
            scene_is_sky(forest->scene, (int32_t)patch->id.root) ||
            material_is_dark(forest_material(forest, (int32_t)p)))
            continue;
        double sum = leaf_irradiance(forest, (int32_t)p, unit).band[0];
        double square = area * (sum - 1.0) * (sum - 1.0);
        sums.min = fmin(sums.min, sum);
        sums.max = fmax(sums.max, sum);
        sums.area = flux_add(sums.area, flux_from_watts(coarse, area));
        sums.rows = flux_add(sums.rows, flux_from_watts(coarse, area * sum));
        sums.squares = flux_add(sums.squares, flux_from_watts(coarse, square));
    }
    return sums;
}
