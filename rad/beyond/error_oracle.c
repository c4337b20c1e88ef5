/* Refinement by error.
 *
 * A link is split for its errors. On the way from q to p, light is misplaced by
 *
 *     rho_p B_q dG_p       the form factor varies over p: splitting p mends it,
 *     rho_p G dB_q         the radiosity varies over q: splitting q mends it,
 *
 * with dG_p the spread of G over the sub-areas of p (shadows with an edge on p included)
 * and dB_q the range of radiosity over the leaves of q; likewise from p to q. The link
 * itself tells the four children of p apart (patch_link.h). So the spread over p is first
 * of all a reason to give p children, which costs no ray; then the spread within each
 * child is left, about half as large, and the range within each child of q. A sampled
 * link may have missed a shadow or a gap: a part of the unoccluded G is in doubt, less if
 * all segments agree, nothing if the way is proved to be open. (Of near patches G stays
 * in doubt even then: points on a lamp do not show how much light the ceiling close above
 * it receives.) All these are powers; their sum is compared with the threshold, and the
 * side causing more error is split. A link with a cluster is judged alike, but for the
 * part in doubt. */
#include "rad/beyond/error_oracle.h"

#include <math.h>
#include <string.h>

#include "rad/beyond/node.h"
#include "rad/beyond/patch_link.h"
#include "rad/beyond/range.h"
#include "rad/oracle.h"

/* --- errors --- */

static struct rgb reflectance_of(const struct model *model, int32_t node)
{
    return node_is_cluster(node) ? model->clusters->tree->clusters[~node].reflectance
                                 : forest_material(model->forest, node)->reflectance;
}

static struct rgb radiosity_of(const struct model *model, int32_t node)
{
    return node_is_cluster(node) ? model->clusters->radiosity[~node]
                                 : model->forest->radiosity[node];
}

/* Sum over bands of rho B: the sender's light as the receiver reflects it, W/m^2. */
static double light_reflected(const struct model *model, int32_t from, int32_t to)
{
    return rgb_dot(reflectance_of(model, to), radiosity_of(model, from));
}

/* The area of child k of a node, relative; 0 where there is none. */
static double share_of(const struct model *model, int32_t node, int k)
{
    if (!node_is_cluster(node))
        return 0.25;
    const struct cluster_tree *tree = model->clusters->tree;
    int32_t child = tree->clusters[~node].child[k];
    return child == NODE_NONE ? 0.0 : cluster_node_area(tree, model->scene, child) /
                                          tree->clusters[~node].area;
}

/* The spread of G over the children of a node, as an exchange area: the largest less the
 * smallest G if all children were like one, or, with a cluster in the link, twice the sum
 * of the parts' deviations from shares by area: 2 G for all in one half. */
static double spread_of(const struct model *model, const struct link *link, int32_t node,
                        const uint8_t parts[3])
{
    double least = 1.0, most = 0.0, off = 0.0;
    for (int k = 0; k < 4; k++) {
        double part = link_part(parts, k);
        least = real_min(least, part);
        most = real_max(most, part);
        off += fabs(part - share_of(model, node, k));
    }
    return link_area(link) * (link_has_cluster(link) ? 2.0 * off : 4.0 * (most - least));
}

/* Part of the spread over a node left within its children: half where light is linear
 * over a plane; a cluster's are no quarters of one. */
static const double LEFT_OF_PATCHES = 0.5, LEFT_OF_CLUSTERS = 2.0;

/* The error caused by one side: the spread of received light within its children, and the
 * range of sent light. (A range of clusters, from the deviations of the B of their roots,
 * changed no error, and the links by 1 %.) */
static double error_of(const struct model *model, const struct link *link, int32_t own,
                       int32_t other, const uint8_t parts[3])
{
    double left = link_has_cluster(link) ? LEFT_OF_CLUSTERS : LEFT_OF_PATCHES;
    double range =
        node_is_cluster(own) ? 0.0 : forest_range_within(model->forest, own);
    return left * spread_of(model, link, own, parts) *
               light_reflected(model, other, own) +
           link_area(link) * rgb_mean(reflectance_of(model, other)) * range;
}

/* --- doubt --- */

/* Part of the exchange of two patches in doubt where segments agree, unless the way is
 * open and the patches are far apart; where they disagree, as in a half-shade, so many
 * times as much. */
static const double DOUBT = 0.125, DISAGREED = 2.0;

/* G in doubt of two patches. */
static double doubt_of_patches(const struct link *link)
{
    bool agreed = link->seen == 0 || link->seen == LINK_ALL_SEEN ||
                  link->seen == LINK_OPEN_NEAR;
    if (link->seen == LINK_OPEN)
        return 0.0;
    return (agreed ? 1.0 : DISAGREED) * DOUBT * link_unoccluded(link);
}

/* G in doubt of a link with a cluster. Of near ends it is the whole bound: a few pairs of
 * roots may have all of it, whatever a look finds. Of far ends it is what the first look
 * has found without blockers, and at least the part that is in doubt for patches: a look
 * may find nothing at all. The link's own G would not do: links that lack light by chance
 * would stay, and links with too much would be split. The G of the first look is kept in
 * place of a blocker, which such a link lacks. */
static double doubt_of_clusters(const struct link *link, const struct meeting *m)
{
    float judged;
    memcpy(&judged, &link->blocker, sizeof judged);
    return m->near ? m->most : real_max((double)judged, DOUBT * m->most);
}

/* --- sides --- */

/* Of all light the part in the space of a node, 1. */
static double light_part(const struct model *model, int32_t node)
{
    return model->spaces ? model->spaces->light[node_space(model, node)] : 1.0;
}

/* The largest error of a link that stays, W: epsilon times the light of the space of its
 * ends. Hardly any light passes from one space to another, so there the brighter one
 * counts. */
static double threshold_of(const struct model *model, const struct link *link)
{
    return model->link_threshold *
           real_max(light_part(model, link->p), light_part(model, link->q));
}

/* A patch that only reflects is split before a cluster if four times as wide: its parts
 * would have to be linked with each part of the cluster afterwards. (Office3 at epsilon
 * 1e-4: 30 % fewer links than by width alone and an eighth less error, Cornell box at
 * 1e-3 a fifth fewer. With lamps put off, too, things of 2 cm beside a lamp are lost in
 * their clusters: a room of 18,512 triangles has half more error.) */
static const double PUT_OFF = 0.25;

static double width_of(const struct end *end)
{
    return end->cluster || end->emits ? end->radius : PUT_OFF * end->radius;
}

/* The wider one; of equal ones the one with the lower ID. */
static bool p_is_wider(const struct meeting *m)
{
    double width_p = width_of(m->p), width_q = width_of(m->q);
    if (width_p != width_q)
        return width_p > width_q;
    return id_compare(m->p->id, m->q->id) <= 0;
}

/* The side causing more of the error, `doubt`, W, counted to the larger side. If this is
 * a patch that may not be split, the other, where a split there helps. */
static int32_t choose(const struct model *model, const struct link *link, double doubt,
                      bool p_larger)
{
    double error_p = error_of(model, link, link->p, link->q, link->parts_p);
    double error_q = error_of(model, link, link->q, link->p, link->parts_q);
    double threshold = threshold_of(model, link);
    if (error_p + error_q + doubt <= threshold)
        return NODE_NONE;
    error_p += p_larger ? doubt : 0.0;
    error_q += p_larger ? 0.0 : doubt;
    bool p_first = error_p != error_q ? error_p > error_q : p_larger;
    int32_t first = p_first ? link->p : link->q, second = p_first ? link->q : link->p;
    if (node_is_cluster(first) || patch_may_split(model, first))
        return first;
    if (node_is_cluster(second))
        return second;
    bool helps = fmin(error_p, error_q) > 0.5 * threshold;
    return helps && patch_may_split(model, second) ? second : NODE_NONE;
}

static int32_t side_with_cluster(const struct model *model, const struct link *link)
{
    struct end p = end_of(model, link->p), q = end_of(model, link->q);
    struct meeting m = ends_meet(&p, &q);
    bool several_p = node_space(model, link->p) < 0;
    bool several_q = node_space(model, link->q) < 0;
    if (several_p || several_q) /* light would pass from space to space */
        return several_p && (!several_q || p_is_wider(&m)) ? link->p : link->q;
    double doubt = doubt_of_clusters(link, &m) * m.light;
    if (m.near && doubt <= threshold_of(model, link))
        return NODE_NONE;
    return choose(model, link, doubt, p_is_wider(&m));
}

int32_t error_oracle_side_to_split(const struct model *model, const struct link *link)
{
    if (link_has_cluster(link))
        return side_with_cluster(model, link);
    double light = light_reflected(model, link->q, link->p) +
                   light_reflected(model, link->p, link->q);
    return choose(model, link, doubt_of_patches(link) * light,
                  p_is_larger(model->forest, link));
}

int32_t error_oracle_side_by_energy(const struct model *model, const struct link *link)
{
    return link_has_cluster(link) ? side_with_cluster(model, link)
                                  : oracle_side_to_split(model, link);
}

/* --- dividing --- */

/* Divides the receiver `to` if it is a patch. */
static void divide(struct model *model, const struct link *link, int32_t to, int32_t from,
                   const uint8_t parts[3])
{
    if (node_is_cluster(to))
        return;
    double error = spread_of(model, link, to, parts) * light_reflected(model, from, to);
    if (error > threshold_of(model, link) && patch_may_split(model, to))
        forest_split(model->forest, to);
}

void error_oracle_divide(struct model *model, const struct link *link)
{
    divide(model, link, link->p, link->q, link->parts_p);
    divide(model, link, link->q, link->p, link->parts_q);
}
