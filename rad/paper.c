/* The paper's method: every pair of roots is linked, by disks and 16 rays; a link is
 * split if it carries too much energy; light goes over the link to the patches
 * themselves. */
#include "rad/link.h"
#include "rad/oracle.h"

static double emitted_power(struct model *model)
{
    return model->emitted_power;
}

const struct method PAPER = {
    .light_power = emitted_power,
    .make_link = link_make,
    .side_to_split = oracle_side_to_split,
    .split_link = link_split,
    .transfer = links_transfer,
};
