/* phr's method, and the ablations: DEFAULT with an entry exchanged. Links of two patches
 * tell their children apart and are split for their errors; a tree above the roots takes
 * the place of initial linking. */
#include "rad/beyond/error_oracle.h"
#include "rad/beyond/node_link.h"
#include "rad/beyond/patch_link.h"
#include "rad/beyond/range.h"

#include <math.h>

/* The part counted of the light of a closed scene, spread evenly: in ordinary rooms less
 * than the emitted light, in white ones many times as much. */
static const double LASTING = 0.1;

/* The mean radiosity if all light were spread evenly in a closed scene: E / (1 - rho) of
 * means. */
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

/* As emitted or, where light is reflected for long, LASTING of it spread evenly. */
static double light_power(struct model *model)
{
    struct rgb typical = typical_radiosity(model->scene);
    return fmax(model->emitted_power, LASTING * (model->area * rgb_sum(typical)));
}

static void prepare(struct model *model)
{
    struct cluster_light *clusters = model->clusters;
    forest_bound(model->forest);
    if (clusters)
        cluster_light_average(clusters, model->forest, model->forest->radiosity,
                              clusters->radiosity);
}

static struct patch_id node_id(const struct model *model, int32_t node)
{
    if (!node_is_cluster(node))
        return model->forest->patches[node].id;
    return (struct patch_id){CLUSTER_ROOT,
                             model->clusters->tree->clusters[~node].hierarchy};
}

static int32_t node_reach(const struct model *model, struct patch_id id)
{
    return id.root == CLUSTER_ROOT ? cluster_reach(model->clusters->tree, id.hierarchy)
                                   : forest_reach(model->forest, id);
}

const struct method DEFAULT = {
    .node_id = node_id,
    .node_reach = node_reach,
    .light_power = light_power,
    .first_link = node_link_top,
    .prepare = prepare,
    .make_link = patch_link_make,
    .side_to_split = error_oracle_side_to_split,
    .split_link = node_link_split,
    .keep_link = node_link_keep,
    .transfer = node_links_transfer,
};

struct method method_of(const struct criterion *criterion)
{
    bool by_energy = criterion->oracle == ORACLE_BF;
    bool by_disks = criterion->form_factor == FORM_FACTOR_DISK;
    bool all_pairs = criterion->linking == LINKING_PAIRS;
    if (by_energy && by_disks && all_pairs)
        return PAPER;
    struct method method = DEFAULT;
    if (by_energy)
        method.side_to_split = error_oracle_side_by_energy;
    if (by_disks)
        method.make_link = link_make;
    if (all_pairs) {
        method.light_power = NULL;
        method.first_link = NULL;
    }
    return method;
}
