/* The paper's method: every pair of roots is linked, by disks and 16 rays; a link with
 * too much energy is split; light goes over the link to the patches themselves. */
#include "rad/link.h"
#include "rad/oracle.h"

static struct patch_id patch_id_of(const struct model *model, int32_t patch)
{
    return model->forest->patches[patch].id;
}

static int32_t reach_patch(const struct model *model, struct patch_id id)
{
    return forest_reach(model->forest, id);
}

static int32_t child_of(const struct model *model, int32_t patch, int k)
{
    return forest_child(model->forest, patch, k);
}

const struct method PAPER = {
    .node_id = patch_id_of,
    .node_reach = reach_patch,
    .node_child = child_of,
    .make_link = link_make,
    .side_to_split = oracle_side_to_split,
    .split_link = link_split,
    .transfer = links_transfer,
};
