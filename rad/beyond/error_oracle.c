/* Refinement by error.
 *
 * A link is split for its errors. On the way from q to p, light is misplaced by
 *
 *     rho_p B_q dG_p       the form factor varies over p: splitting p mends it,
 *     rho_p G dB_q         the radiosity varies over q: splitting q mends it,
 *
 * with dG_p the spread of G over the sub-areas of p (shadows that begin or end on p are
 * in it) and dB_q the range of radiosity over the leaves of q; likewise from p to q. The
 * link itself tells the four children of p apart (patch_link.h). So the spread over p is
 * first of all a reason to give p children, which costs no ray; then the spread within
 * each child is left, about half as large, and the range within each child of q. A
 * sampled link may have missed a shadow or a gap: a part of the unoccluded G is in doubt,
 * less if all segments agree, nothing if the way is proved to be open. (Then it is still
 * in doubt if the patches are near: points on a lamp do not show how much light the
 * ceiling close above it receives.) All these are powers; their sum is compared with the
 * threshold, and the side that causes more of it is split. */
#include "rad/beyond/error_oracle.h"

#include <math.h>

#include "rad/beyond/patch_link.h"
#include "rad/beyond/range.h"
#include "rad/oracle.h"

/* Sum over bands of rho B: the sender's light as the receiver reflects it, W/m^2. */
static double light_reflected(const struct forest *forest, int32_t from, int32_t to)
{
    return rgb_dot(forest_material(forest, to)->reflectance,
                   forest->radiosity[from]);
}

/* Part of the exchange that is in doubt when segments disagree, when all agree, and when
 * it is open but near; part of the spread over a patch that is left within its children.
 * The errors that come of half or twice these at the same number of links differ by less
 * than a tenth (Cornell box). */
static const double DOUBT_MIXED = 0.25, DOUBT_AGREED = 0.125, DOUBT_NEAR = 0.0625;
static const double SPREAD_LEFT = 0.5;

static double doubt_of(const struct link *link)
{
    if (link->seen == LINK_OPEN)
        return 0.0;
    if (link->seen == LINK_OPEN_NEAR)
        return link_unoccluded(link) * DOUBT_NEAR;
    bool agreed = link->seen == 0 || link->seen == LINK_ALL_SEEN;
    return link_unoccluded(link) * (agreed ? DOUBT_AGREED : DOUBT_MIXED);
}

/* Largest less smallest part, as exchange areas of a whole patch that is like it. */
static double spread_of(const struct link *link, const uint8_t parts[3])
{
    int last = 256 - parts[0] - parts[1] - parts[2], least = last, most = last;
    for (int k = 0; k < 3; k++) {
        least = parts[k] < least ? parts[k] : least;
        most = parts[k] > most ? parts[k] : most;
    }
    return 4.0 / 256.0 * (most - least) * link_area(link);
}

/* The error that one side causes: the spread of the light that it receives within its
 * children, and the range of the light that it sends. */
static double error_of(const struct model *model, const struct link *link, int32_t own,
                       int32_t other, const uint8_t parts[3], double light)
{
    const struct forest *forest = model->forest;
    return SPREAD_LEFT * spread_of(link, parts) * light +
           link_area(link) * rgb_mean(forest_material(forest, other)->reflectance) *
               forest_range_within(forest, own);
}

int32_t error_oracle_side_to_split(const struct model *model, const struct link *link)
{
    const struct forest *forest = model->forest;
    double to_p = light_reflected(forest, link->q, link->p);
    double to_q = light_reflected(forest, link->p, link->q);
    double error_p = error_of(model, link, link->p, link->q, link->parts_p, to_p);
    double error_q = error_of(model, link, link->q, link->p, link->parts_q, to_q);
    double doubt = doubt_of(link) * (to_p + to_q);
    if (error_p + error_q + doubt <= model->link_threshold)
        return NODE_NONE;
    bool p_larger = p_is_larger(forest, link);
    error_p += p_larger ? doubt : 0.0;
    error_q += p_larger ? 0.0 : doubt;
    bool p_first = error_p != error_q ? error_p > error_q : p_larger;
    int32_t first = p_first ? link->p : link->q, second = p_first ? link->q : link->p;
    if (patch_may_split(model, first))
        return first;
    bool helps = fmin(error_p, error_q) > 0.5 * model->link_threshold;
    return helps && patch_may_split(model, second) ? second : NODE_NONE;
}

/* Divides the patch `to`, which receives. */
static void divide(struct model *model, const struct link *link, int32_t to, int32_t from,
                   const uint8_t parts[3])
{
    double error = spread_of(link, parts) * light_reflected(model->forest, from, to);
    if (error > model->link_threshold && patch_may_split(model, to))
        forest_split(model->forest, to);
}

void error_oracle_divide(struct model *model, const struct link *link)
{
    if (link->seen == 0)
        return;
    divide(model, link, link->p, link->q, link->parts_p);
    divide(model, link, link->q, link->p, link->parts_q);
}
