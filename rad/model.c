/* Thresholds in the units of the run; see rad/model.h.
 *
 * Energy is compared as the sum over the three bands, on both sides, so one epsilon
 * serves every colour of light. */
#include "rad/model.h"

#include <math.h>

static double largest_reflectance(const struct scene *scene)
{
    double largest = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        for (int c = 0; c < BANDS; c++)
            largest = fmax(largest,
                           scene_root_material(scene, root)->reflectance.band[c]);
    return largest;
}

struct model model_make(const struct scene *scene, const struct octree *octree,
                        struct forest *forest, const struct criterion *criterion,
                        struct method method)
{
    struct model model = {
        .scene = scene,
        .octree = octree,
        .forest = forest,
        .criterion = *criterion,
        .method = method,
        .area = scene_own_area(scene),
        .whole_area = scene_area(scene),
        .emitted_power = scene_entering_power(scene),
        .absorptance = 1.0 - largest_reflectance(scene),
        .patch_threshold = criterion->min_area * scene_own_area(scene),
    };
    /* 16 times the most light of a closed scene: rows may sum to more than 1. */
    model.flux_unit =
        flux_unit_for(16.0 * scene_emitted_power(scene) / model.absorptance);
    model_set_epsilon(&model, criterion->epsilon);
    return model;
}

void model_set_epsilon(struct model *model, double epsilon)
{
    double light = model->emitted_power;
    if (model->method.light_power)
        light = model->method.light_power(model);
    model->criterion.epsilon = epsilon;
    model->link_threshold = epsilon * light;
}
