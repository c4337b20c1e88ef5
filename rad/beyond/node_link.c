/* Links with a cluster in them: making, splitting, transfer.
 *
 * Stopping bias (Kirk and Arvo 1991): a link whose few samples happen to miss its light
 * looks good, is accepted, and stays too dark: 2.4 % of all light in a room of 18,000
 * triangles. So an accepted link is estimated afresh, from points without a say in the
 * decision, and keeps the G of its first look for the passes to come.
 *
 * A link that sees nothing stays, at the cost of 24 bytes, unless one wall is proved to
 * hide all: that no sample arrives is no proof. */
#include "rad/beyond/node_link.h"

#include <string.h>

#include "rad/beyond/node_exchange.h"
#include "rad/beyond/patch_link.h"

/* --- looks --- */

/* G without blockers, found by the first look: see doubt_of_clusters(). */
static void set_judged(struct link *link, double unoccluded)
{
    float area = (float)unoccluded;
    memcpy(&link->blocker, &area, sizeof area);
}

/* Finds the parts of children to exchange `area` in the proportions of `g`, none more
 * than its own area. Returns the exchange area left. */
static double find_parts(const struct model *model, const struct end *end,
                         const double g[4], double area, uint8_t parts[3])
{
    double exact[4], sum = 0.0, kept = 0.0;
    for (int k = 0; k < 4; k++)
        sum += g[k];
    for (int k = 0; k < 4; k++) {
        double most = end_child_area(model, end, k);
        exact[k] = area > 0.0 ? real_min(g[k] * (area / sum), most) : most / end->area;
        kept += exact[k];
    }
    for (int k = 0; k < 4; k++)
        exact[k] /= kept;
    link_set_parts(parts, exact);
    return area > 0.0 ? kept : 0.0;
}

/* Fills G, parts and visibility of a link. */
static void look(struct model *model, const struct meeting *m, int salt,
                 struct link *link)
{
    struct octree_counts before = model->counts;
    struct node_exchange found = node_exchange_estimate(model, m, salt);
    double seen = found.unoccluded > 0.0 ? found.area / found.unoccluded : 0.0;
    double area = find_parts(model, m->p, found.g_p, found.area, link->parts_p);
    area = find_parts(model, m->q, found.g_q, area, link->parts_q);
    if (salt == 0)
        set_judged(link, found.unoccluded);
    area *= link->p == link->q ? 0.5 : 1.0;
    link->seen = area > 0.0 ? link_seen(seen) : 0;
    link->area = float_below(area > 0.0 ? area : found.unoccluded);
    double tests = (double)(model->counts.node_tests + model->counts.triangle_tests -
                            before.node_tests - before.triangle_tests);
    link->cost = compact8(real_max(1.0, tests));
    model->estimating += TESTS_PER_EXCHANGE;
    model->rays_spared += BUNDLE_RAYS - (model->counts.rays - before.rays);
}

/* --- making and splitting --- */

struct link node_link_top(void)
{
    return (struct link){.p = NODE_TOP, .q = NODE_TOP, .cost = compact8(1.0)};
}

/* The link of two patches, the lower ID first: the choice of points must not depend on
 * the way here through the clusters. */
static bool make_of_patches(struct model *model, const struct end *p,
                            const struct end *q, struct link *link)
{
    bool in_order = id_compare(p->id, q->id) < 0;
    const struct end *first = in_order ? p : q, *second = in_order ? q : p;
    return model->method.make_link(model, first->node, &first->facet, second->node,
                                   &second->facet, NULL, link);
}

/* Makes the link of two ends. False if no light can ever pass. */
static bool make(struct model *model, const struct end *p, const struct end *q,
                 struct link *link)
{
    if ((p->is_dark && q->is_dark) || !ends_may_face(p, q))
        return false;
    if (!p->cluster && !q->cluster)
        return make_of_patches(model, p, q, link);
    *link = (struct link){.p = p->node, .q = q->node, .cost = compact8(1.0)};
    struct meeting m = ends_meet(p, q);
    if (m.near)
        return true;
    look(model, &m, 0, link);
    if (link->seen > 0 || !ends_are_walled_off(p, q, model->octree, &model->counts))
        return true;
    model->walled_off++;
    return false;
}

static int split_itself(struct model *model, int32_t node,
                        struct link *children)
{
    struct end whole = end_of(model, node), ends[4];
    int parts = 0, count = 0;
    for (; parts < 4 && whole.cluster->child[parts] != NODE_NONE; parts++)
        ends[parts] = end_of(model, whole.cluster->child[parts]);
    for (int a = 0; a < parts; a++)
        for (int b = a; b < parts; b++)
            count += (a != b || ends[a].cluster) &&
                     make(model, &ends[a], &ends[b], &children[count]);
    return count;
}

int node_link_split(struct model *model, const struct link *link, int32_t node,
                    struct link *children)
{
    if (!link_has_cluster(link))
        return patch_link_split(model, link, node, children);
    if (link->p == link->q)
        return split_itself(model, node, children);
    if (!node_is_cluster(node))
        forest_split(model->forest, node);
    bool of_p = node == link->p;
    struct end other = end_of(model, of_p ? link->q : link->p);
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int32_t child = node_child(model, node, k);
        if (child == NODE_NONE)
            break;
        struct end part = end_of(model, child);
        count += of_p ? make(model, &part, &other, &children[count])
                      : make(model, &other, &part, &children[count]);
    }
    return count;
}

void node_link_keep(struct model *model, struct link *link)
{
    if (!link_has_cluster(link))
        return;
    struct end p = end_of(model, link->p), q = end_of(model, link->q);
    struct meeting m = ends_meet(&p, &q);
    look(model, &m, 1, link);
}

/* --- transfer ---
 *
 * Light brought by a link to a node with children is dealt to the children by the link's
 * parts, and light sent by the children is weighted by the parts. This costs no ray,
 * since the parts come from the looks for G. With even parts of a patch the result is the
 * same as light to the patch itself. */

/* True if light to and from a node is its children's, by the parts, and not the node's
 * own: of a cluster, and of a patch with children unless the parts are even. */
static bool is_divided(const struct model *model, int32_t node, const uint8_t parts[3])
{
    return node_is_cluster(node) ||
           (!patch_is_leaf(&model->forest->patches[node]) &&
            !(parts[0] == 64 && parts[1] == 64 && parts[2] == 64));
}

/* What light to and from a node is shared among. */
struct shares {
    int count;
    int32_t node[4]; /* [count] */
    double part[4];  /* [count] of the light, 1 */
};

/* The node itself; or its children by the parts, of which the last one has the rest. */
static inline struct shares shares_of(const struct model *model, int32_t node,
                                      const uint8_t parts[3])
{
    struct shares shares = {1, {node}, {1.0}};
    int rest = 256;
    if (!is_divided(model, node, parts))
        return shares;
    for (int k = 0; k < 4 && node_child(model, node, k) != NODE_NONE; k++) {
        int own = k < 3 ? parts[k] : rest;
        shares.node[k] = node_child(model, node, k);
        shares.part[k] = own * (1.0 / 256.0);
        shares.count = k + 1;
        rest -= own;
    }
    shares.part[shares.count - 1] += rest * (1.0 / 256.0);
    return shares;
}

/* The light taken by a link from those sharing it, of a vector [patches]. */
static inline struct rgb take(const struct model *model, const struct shares *shares,
                              const struct rgb *vector)
{
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < shares->count; k++) {
        int32_t node = shares->node[k];
        rgb_add(&sum, shares->part[k], node_is_cluster(node)
                                           ? model->clusters->sent[~node] : vector[node]);
    }
    return sum;
}

/* Adds light, G B, to the flux of those sharing the light. */
static inline void give(const struct model *model, const struct shares *shares,
                        double area, const struct rgb *radiosity, struct flux_unit unit)
{
    for (int k = 0; k < shares->count; k++) {
        int32_t node = shares->node[k];
        int64_t *flux = node_is_cluster(node)
                            ? model->clusters->flux + BANDS * (int64_t)~node
                            : model->forest->patches[node].flux;
        for (int c = 0; c < BANDS; c++)
            flux[c] +=
                flux_from_watts(unit, shares->part[k] * (area * radiosity->band[c]));
    }
}

int node_link_ends(const struct model *model, const struct link *link,
                   int32_t nodes[METHOD_ENDS_MAX])
{
    struct shares sides[2] = {shares_of(model, link->p, link->parts_p),
                              shares_of(model, link->q, link->parts_q)};
    int count = 0;
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < sides[side].count; k++)
            nodes[count++] = sides[side].node[k];
    return count;
}

void node_links_transfer(const struct link_list *list, const struct model *model,
                         const struct rgb *vector, struct flux_unit unit)
{
    for (int64_t i = 0; i < list->seen; i++) {
        const struct link *link = &list->items[i];
        struct shares p = shares_of(model, link->p, link->parts_p);
        struct shares q = shares_of(model, link->q, link->parts_q);
        struct rgb from_p = take(model, &p, vector), from_q = take(model, &q, vector);
        give(model, &p, (double)link->area, &from_q, unit);
        give(model, &q, (double)link->area, &from_p, unit);
    }
}
