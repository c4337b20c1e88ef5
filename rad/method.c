/* Thresholds in the units of the run; see rad/method.h.
 *
 * Energy is compared as the sum over the three bands, on both sides, so one epsilon serves
 * every colour of light. */
#include "rad/method.h"

struct method method_make(const struct scene *scene, const struct octree *octree,
                          struct forest *forest, const struct criterion *criterion)
{
    return (struct method){
        .scene = scene,
        .octree = octree,
        .forest = forest,
        .criterion = *criterion,
        .flux_unit = flux_unit_choose(scene),
        .link_threshold = criterion->epsilon * scene_emitted_power(scene),
        .patch_threshold = criterion->min_area * scene_area(scene),
    };
}
