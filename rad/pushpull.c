/* Push-pull.
 *
 * Push: irradiance goes down, H(child) = H(parent) + Phi(child) / A(child). Since only leaves
 * reflect, each leaf adds up its own line of ancestors, at most 16 terms, from the root down.
 * Pull: B goes up; children have equal areas, so a parent's B is their plain mean. A child is
 * always created after its parent, so one loop over the local numbers downwards meets children
 * before parents, and no recursion is needed.
 *
 * Convergence. With the links fixed, one iteration maps the change dB of the last one by the
 * matrix M = rho F, and what is still to come is (M + M^2 + ...) dB. If M takes the change of no
 * root to more than q times itself, that is at most q / (1 - q) dB (Collatz and Wielandt's
 * bound on the largest eigenvalue, taken over roots). The q that was seen is `shrink`; the paper
 * stops when dB itself is small, which is wrong by 1 / (1 - rho). Roots that change by a small
 * part of the tolerance are left out: they may be slow, but have little to add, and if they had
 * much together it would show in the ratio of the whole change, which the vote looks at too. */
#include "rad/pushpull.h"

#include <math.h>
#include <stddef.h>

#include "geom/alloc.h"

/* A root is settled when its change per area, over the mean emission, falls below this part of
 * the tolerance. */
static const double SETTLED = 0.1;

struct rgb leaf_irradiance(const struct forest *forest, int32_t leaf, struct flux_unit unit)
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

/* Gives a leaf its new radiosity and adds what that means to the sums. Returns the change. */
static int64_t update_leaf(const struct model *model, struct flux_unit flux, int32_t leaf,
                           struct push_pull_sums *sums)
{
    struct patch *patch = &model->forest->patches[leaf];
    const struct material *material = forest_material(model->forest, leaf);
    struct rgb irradiance = leaf_irradiance(model->forest, leaf, flux);
    double area = forest_area(model->forest, leaf);
    double light = 0.0, absorbed = 0.0, arriving = 0.0, change = 0.0;
    for (int c = 0; c < BANDS; c++) {
        double rho = material->reflectance.band[c];
        double h = irradiance.band[c];
        double b = material->emission.band[c] + rho * h;
        light += area * b;
        absorbed += area * ((1.0 - rho) * h);
        arriving += area * h;
        change += area * fabs(b - patch->radiosity.band[c]);
        patch->radiosity.band[c] = b;
    }
    sums->light = flux_add(sums->light, flux_from_watts(model->flux_unit, light));
    sums->arriving = flux_add(sums->arriving, flux_from_watts(model->flux_unit, arriving));
    sums->absorbed = flux_add(sums->absorbed, flux_from_watts(model->flux_unit, absorbed));
    return flux_from_watts(model->flux_unit, change);
}

void forest_average_patch(struct forest *forest, int32_t p)
{
    struct patch *patch = &forest->patches[p];
    if (patch_is_leaf(patch))
        return;
    const struct patch *child = &forest->patches[patch->children];
    for (int c = 0; c < BANDS; c++)
        patch->radiosity.band[c] =
            0.25 * ((child[0].radiosity.band[c] + child[1].radiosity.band[c]) +
                    (child[2].radiosity.band[c] + child[3].radiosity.band[c]));
}

void forest_average(struct forest *forest)
{
    for (int64_t p = forest->count - 1; p >= 0; p--)
        forest_average_patch(forest, (int32_t)p);
}

static double largest_shrink(const struct model *model, const bool *own, const int64_t *before,
                             const int64_t *now)
{
    const struct scene *scene = model->scene;
    double settled = SETTLED * model->criterion.tolerance * model->emitted_power /
                     model->area; /* change per area at which a root is settled, W/m^2 */
    double largest = 0.0;
    for (int32_t root = 0; root < model->forest->root_count; root++) {
        double watts = settled * scene_root_area(scene, root);
        if (!own[root] || now[root] <= flux_from_watts(model->flux_unit, watts))
            continue;
        double shrink = before[root] > 0 ? (double)now[root] / (double)before[root] : HUGE_VAL;
        largest = fmax(largest, shrink);
    }
    return largest;
}

struct push_pull_sums push_pull(const struct model *model, struct flux_unit flux,
                                const bool *own, int64_t *root_change)
{
    struct forest *forest = model->forest;
    struct push_pull_sums sums = {0};
    int64_t *now = alloc_array((size_t)forest->root_count, sizeof *now);
    for (int64_t p = 0; p < forest->count; p++) {
        const struct patch *patch = &forest->patches[p];
        uint32_t root = patch->id.root;
        if (!own[root] || scene_root_area(model->scene, (int32_t)root) <= 0.0)
            continue;
        if (!patch_is_leaf(patch))
            continue;
        int64_t change = update_leaf(model, flux, (int32_t)p, &sums);
        now[root] = flux_add(now[root], change);
        sums.change = flux_add(sums.change, change);
    }
    sums.shrink = largest_shrink(model, own, root_change, now);
    for (int32_t root = 0; root < forest->root_count; root++)
        root_change[root] = now[root];
    alloc_free(now);
    for (int64_t p = forest->count - 1; p >= 0; p--)
        if (own[forest->patches[p].id.root])
            forest_average_patch(forest, (int32_t)p);
    return sums;
}
