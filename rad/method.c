/* Thresholds in the units of the run; see rad/method.h.
 *
 * Energy is compared as the sum over the three bands, on both sides, so one epsilon serves
 * every colour of light. */
#include "rad/method.h"

/* The mean radiosity if all light were spread evenly in a closed scene: E / (1 - rho) of means. */
static struct rgb typical_radiosity(const struct scene *scene)
{
    struct rgb emitted = {{0.0, 0.0, 0.0}}, absorbing = {{0.0, 0.0, 0.0}};
    for (int32_t root = 0; root < scene_root_count(scene); root++) {
        const struct material *material = scene_root_material(scene, root);
        double area = scene_root_area(scene, root);
        for (int c = 0; c < BANDS; c++) {
            emitted.band[c] += area * material->emission.band[c];
            absorbing.band[c] += area * (1.0 - material->reflectance.band[c]);
        }
    }
    for (int c = 0; c < BANDS; c++)
        emitted.band[c] /= absorbing.band[c];
    return emitted;
}

struct method method_make(const struct scene *scene, const struct octree *octree,
                          struct forest *forest, const struct criterion *criterion)
{
    return (struct method){
        .scene = scene,
        .octree = octree,
        .forest = forest,
        .criterion = *criterion,
        .flux_unit = flux_unit_choose(scene),
        .area = scene_area(scene),
        .emitted_power = scene_emitted_power(scene),
        .link_threshold = criterion->epsilon * scene_emitted_power(scene),
        .typical = typical_radiosity(scene),
        .patch_threshold = criterion->min_area * scene_area(scene),
    };
}
