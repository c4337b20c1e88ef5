/* BF refinement (Sec. 2.2 and 3.3): "if the total exchanged energy exceeds a certain
 * threshold, the patch with the bigger area is subdivided". The energy is Eq. 2's, v_pq
 * F_pq A_p B_q, both ways together, summed over the bands. Only patches that may be split
 * are. */
#include "rad/oracle.h"

bool patch_may_split(const struct model *model, int32_t patch)
{
    const struct forest *forest = model->forest;
    return id_level(forest->patches[patch].id) < model->criterion.max_level &&
           0.25 * forest_area(forest, patch) >= model->patch_threshold;
}

bool p_is_larger(const struct forest *forest, const struct link *link)
{
    double area_p = forest_area(forest, link->p), area_q = forest_area(forest, link->q);
    if (area_p != area_q)
        return area_p > area_q;
    return id_compare(forest->patches[link->p].id, forest->patches[link->q].id) < 0;
}

int32_t oracle_side_to_split(const struct model *model, const struct link *link)
{
    const struct rgb *radiosity = model->forest->radiosity;
    double energy = link_area(link) * (rgb_sum(radiosity[link->p]) +
                                       rgb_sum(radiosity[link->q]));
    int32_t larger = p_is_larger(model->forest, link) ? link->p : link->q;
    return energy > model->link_threshold && patch_may_split(model,
                                                             larger) ? larger : NODE_NONE;
}
