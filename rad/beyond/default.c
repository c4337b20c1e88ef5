/* phr's method, and the ablations: DEFAULT with an entry exchanged. Links of two patches
 * tell their children apart and are split for their errors; a tree above the roots takes
 * the place of initial linking. */
#include "rad/beyond/error_oracle.h"
#include "rad/beyond/node.h"
#include "rad/beyond/node_link.h"
#include "rad/beyond/patch_link.h"

static double light_power(struct model *model)
{
    return scene_light(model->scene);
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

static int32_t child_of(const struct model *model, int32_t node, int k)
{
    return node_child(model, node, k);
}

const struct method DEFAULT = {
    .node_id = node_id,
    .node_reach = node_reach,
    .node_child = child_of,
    .light_power = light_power,
    .first_link = node_link_top,
    .make_link = patch_link_make,
    .side_to_split = error_oracle_side_to_split,
    .split_link = node_link_split,
    .keep_link = node_link_keep,
    .divide = error_oracle_divide,
    .ends = node_link_ends,
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
