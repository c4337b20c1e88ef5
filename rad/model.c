/* Thresholds in the units of the run; see rad/model.h.
 *
 * Energy is compared as the sum over the three bands, on both sides, so one epsilon
 * serves every colour of light. */
#include "rad/model.h"

struct model model_make(const struct scene *scene, const struct octree *octree,
                        struct forest *forest, const struct criterion *criterion)
{
    struct model model = {
        .scene = scene,
        .octree = octree,
        .forest = forest,
        .criterion = *criterion,
        .method = method_of(criterion),
        .flux_unit = flux_unit_choose(scene),
        .area = scene_area(scene),
        .emitted_power = scene_emitted_power(scene),
        .patch_threshold = criterion->min_area * scene_area(scene),
    };
    model_set_epsilon(&model, criterion->epsilon);
    return model;
}

void model_set_epsilon(struct model *model, double epsilon)
{
    model->criterion.epsilon = epsilon;
    model->link_threshold = epsilon * model->method.light_power(model);
}
