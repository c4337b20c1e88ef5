/* The model of a run, and the paper's method: every pair of roots is linked, by disks and
 * 16 rays; a link is split if it carries too much energy; light goes over the link to
 * the patches themselves.
 *
 * Energy is compared as the sum over the three bands, on both sides, so one epsilon
 * serves every colour of light. */
#include "rad/model.h"

#include <math.h>

#include "rad/link.h"
#include "rad/oracle.h"

static double emitted_power(struct model *model)
{
    return model->emitted_power;
}

static struct patch_id patch_id_of(const struct model *model, int32_t patch)
{
    return model->forest->patches[patch].id;
}

static int32_t reach_patch(const struct model *model, struct patch_id id)
{
    return forest_reach(model->forest, id);
}

const struct method PAPER = {
    .node_id = patch_id_of,
    .node_reach = reach_patch,
    .light_power = emitted_power,
    .make_link = link_make,
    .side_to_split = oracle_side_to_split,
    .split_link = link_split,
    .transfer = links_transfer,
};

/* A unit for powers that ranks add: from the emitted power and the largest reflectance
 * rho, since the light in a closed scene adds up to at most power / (1 - rho). 16 times
 * that leaves room for form factors whose rows sum to more than 1. */
static struct flux_unit choose_flux_unit(const struct scene *scene)
{
    double largest = 0.0;
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        for (int c = 0; c < BANDS; c++)
            largest = fmax(largest,
                           scene_root_material(scene, root)->reflectance.band[c]);
    return flux_unit_for(16.0 * scene_emitted_power(scene) / (1.0 - largest));
}

struct model model_make(const struct scene *scene, const struct octree *octree,
                        struct forest *forest, const struct criterion *criterion)
{
    struct model model = {
        .scene = scene,
        .octree = octree,
        .forest = forest,
        .criterion = *criterion,
        .method = method_of(criterion),
        .flux_unit = choose_flux_unit(scene),
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
