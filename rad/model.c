/* Thresholds in the units of the run; see rad/model.h.
 *
 * Energy is compared as the sum over the three bands, on both sides, so one epsilon serves
 * every colour of light. */
#include "rad/model.h"

#include <math.h>

/* Of the light that there would be if it were spread evenly in a closed scene, this part
 * counts: in ordinary rooms less than what is emitted, in white ones many times as much. */
static const double LASTING = 0.1;

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

/* Power of all light, W: as emitted or, where it is reflected for long, a part of what
 * there would be if it were spread evenly. */
static double power_of_light(const struct scene *scene, const struct criterion *criterion)
{
    double emitted = scene_emitted_power(scene);
    double spread = scene_area(scene) * rgb_sum(typical_radiosity(scene));
    return criterion->linking == LINKING_TREE ? fmax(emitted, LASTING * spread) : emitted;
}

struct model model_make(const struct scene *scene, const struct octree *octree,
                          struct forest *forest, const struct criterion *criterion)
{
    return (struct model){
        .scene = scene,
        .octree = octree,
        .forest = forest,
        .criterion = *criterion,
        .flux_unit = flux_unit_choose(scene),
        .area = scene_area(scene),
        .emitted_power = scene_emitted_power(scene),
        .light_power = power_of_light(scene, criterion),
        .link_threshold = criterion->epsilon * power_of_light(scene, criterion),
        .typical = typical_radiosity(scene),
        .patch_threshold = criterion->min_area * scene_area(scene),
    };
}
