/* An oracle for the table PAPER of rad/paper.c (chapter 6): splits by F alone, whatever
 * light goes over the link. */
#include <math.h>

#include "rad/oracle.h"

static int32_t side_by_factor(const struct model *model, const struct link *link)
{
    const struct forest *forest = model->forest;
    double smaller = fmin(forest_area(forest, link->p), forest_area(forest, link->q));
    int32_t larger = p_is_larger(forest, link) ? link->p : link->q;
    bool is_split = link_area(link) > model->criterion.epsilon * smaller &&
                    patch_may_split(model, larger);
    return is_split ? larger : NODE_NONE;
}
