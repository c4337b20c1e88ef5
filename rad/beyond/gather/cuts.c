/* Cuts.
 *
 * From the top of the tree downwards, a node is in the cut as soon as it is small for
 * its distance and would get no more than one segment, if these were dealt by light.
 *
 * The visible shares decide only how segments are dealt, and how unsure a leaf is after
 * finding nothing; no share stands for light itself. Of a node with k of n segments seen
 * the share is taken for (k + m) / (n + 1), with the mean share m of all nodes of the
 * cut: so no share is 0, and a node behind a wall with a window counts for less than one
 * behind a leg of a chair. */
#include "rad/beyond/gather/cuts.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* Leaves of a region, at most; segments to tell how much of a node is seen, at least, and
 * the rays from a leaf for which there is one. */
enum { REGION_LEAVES = 64, PILOTS = 16 };

/* A node is small if its radius is at most this part of its distance. */
static const double SMALL = 0.25;

/* --- regions --- */

/* Counts the leaves of a patch. */
static int32_t leaves_of(const struct forest *forest, int32_t patch)
{
    const struct patch *self = &forest->patches[patch];
    int32_t count = 0;
    for (int k = 0; k < 4 && !patch_is_leaf(self); k++)
        count += leaves_of(forest, self->children + k);
    return patch_is_leaf(self) ? 1 : count;
}

/* Makes all leaves of a node part of a region, or, if this is -1, adds the node's
 * regions. `before`: [root_count + 1] leaves before a place in the tree. */
static void name_leaves(struct regions *regions, const struct model *model, int32_t node,
                        const int64_t *before, int32_t region)
{
    bool cluster = node_is_cluster(node);
    const struct cluster *self =
        cluster ? &model->clusters->tree->clusters[~node] : NULL;
    bool leaf = !cluster && patch_is_leaf(&model->forest->patches[node]);
    bool few = leaf || (cluster ? before[self->end] - before[self->first]
                                : leaves_of(model->forest, node)) <= REGION_LEAVES;
    if (region < 0 && few && node_space(model, node) >= 0) {
        RESERVE(regions->nodes, &regions->capacity, regions->count + 1);
        region = (int32_t)regions->count++;
        regions->nodes[region] = node;
    }
    if (leaf)
        regions->of[node] = region;
    for (int k = 0; k < 4 && !leaf; k++)
        if (node_child(model, node, k) != NODE_NONE)
            name_leaves(regions, model, node_child(model, node, k), before, region);
}

struct regions *regions_create(const struct model *model)
{
    const struct cluster_tree *tree = model->clusters->tree;
    struct regions *regions = alloc_array(1, sizeof *regions);
    int64_t *before = alloc_array((size_t)tree->root_count + 1, sizeof *before);
    regions->of = alloc_array((size_t)model->forest->count, sizeof *regions->of);
    for (int64_t p = 0; p < model->forest->count; p++)
        regions->of[p] = -1;
    for (int32_t place = 0; place < tree->root_count; place++)
        before[place + 1] = before[place] + leaves_of(model->forest, tree->roots[place]);
    name_leaves(regions, model, NODE_TOP, before, -1);
    alloc_free(before);
    return regions;
}

void regions_destroy(struct regions *regions)
{
    if (!regions)
        return;
    alloc_free(regions->nodes);
    alloc_free(regions->of);
    alloc_free(regions);
}

/* --- cuts --- */

struct cuts *cuts_create(const struct senders *senders, const struct regions *regions,
                         const struct panes *panes, int segments)
{
    struct cuts *cuts = alloc_array(1, sizeof *cuts);
    cuts->senders = senders;
    cuts->regions = regions;
    cuts->panes = panes;
    cuts->segments = segments;
    cuts->cuts = alloc_array((size_t)regions->count, sizeof *cuts->cuts);
    for (int64_t i = 0; i < regions->count; i++)
        cuts->cuts[i].first = -1;
    return cuts;
}

void cuts_destroy(struct cuts *cuts)
{
    if (!cuts)
        return;
    alloc_free(cuts->cuts);
    alloc_free(cuts->nodes);
    alloc_free(cuts);
}

double cuts_blind_part(const struct senders *senders, const struct sender_node *node,
                       int32_t space)
{
    if (node->space == space || node->space < 0)
        return 1.0;
    const double *light = senders->model->spaces->light;
    return real_min(1.0, light[space] / light[node->space]);
}

/* Appends the nodes of a cut below a node. `most`: light of one of these, at most, W/m^2.
 * Returns the light of all. */
static double add_nodes(struct cuts *cuts, const struct bounds *region, int32_t space,
                        int32_t number, double most)
{
    const struct sender_node *node = &cuts->senders->nodes[number];
    double worth = sender_node_worth(cuts->senders, node, region) *
                   cuts_blind_part(cuts->senders, node, space);
    double sum = 0.0;
    if (!(worth > 0.0))
        return 0.0;
    struct vec3 apart = vec3_sub(node->bounds.middle, region->middle);
    double reach = node->bounds.radius + region->radius;
    double far = real_max(vec3_length(apart) - reach, region->radius);
    bool small = node->bounds.radius <= SMALL * far && node->space >= 0;
    if (node->child[0] < 0 || (small && worth <= most)) {
        RESERVE(cuts->nodes, &cuts->capacity, cuts->count + 1);
        cuts->nodes[cuts->count++] = (struct cut_node){.node = number, .upto = worth};
        return worth;
    }
    for (int k = 0; k < 4 && node->child[k] >= 0; k++)
        sum += add_nodes(cuts, region, space, node->child[k], most);
    return sum;
}

/* A point of a surface. */
struct spot {
    struct vec3 at, normal;
    int32_t input; /* triangle */
};

static struct spot spot_on(const struct forest *forest, int32_t patch, double u, double v)
{
    struct facet facet = facet_make(forest, patch);
    return (struct spot){triangle_of_square(&facet.triangle, u, v), facet.plane.normal,
                         facet.input};
}

/* A point of a region, evenly distributed; `pick` chooses one of its roots. */
static struct spot spot_in(const struct model *model, int32_t node, double pick,
                           const double u[SEQUENCE_DIMENSIONS])
{
    if (node_is_cluster(node)) {
        const struct cluster_tree *tree = model->clusters->tree;
        const struct cluster *cluster = &tree->clusters[~node];
        const double *before = tree->area_before;
        int64_t place = cluster->first +
                        sum_place(before + cluster->first + 1,
                                  cluster->end - cluster->first,
                                  before[cluster->first] + pick * cluster->area);
        node = tree->roots[place];
    }
    return spot_on(model->forest, node, u[0], u[1]);
}

/* True if a pane aimed at, other than `patch`, is between the spots: that pane brings the
 * light. */
static bool is_behind_pane(const struct cuts *cuts, const struct spot *from,
                           const struct spot *to, int32_t patch,
                           struct octree_counts *counts)
{
    struct pane_walk walk = pane_walk_to(point_above(from->at, from->normal),
                                         point_above(to->at, to->normal));
    return panes_put_aside(cuts->panes, walk, patch, counts);
}

/* Asks segments between a region and a node of its cut how many of those whose ends face
 * each other are seen: sets `asked`, and `seen` to a number. */
static void ask(const struct cuts *cuts, int32_t region, struct cut_node *node,
                struct octree_counts *counts)
{
    const struct model *model = cuts->senders->model;
    struct sequence sequence =
        sequence_start(hash_mix((uint64_t)region) ^ (uint64_t)node->node);
    double start = hash_unit(sequence.scramble[0]);
    int pilots = cuts->segments / PILOTS > PILOTS ? cuts->segments / PILOTS : PILOTS;
    for (int k = 0; k < pilots; k++) {
        double u[SEQUENCE_DIMENSIONS];
        sequence_point(&sequence, (uint32_t)k, u);
        struct choice choice = sender_choose(
            cuts->senders, &cuts->senders->nodes[node->node], (k + start) / pilots);
        struct spot from = spot_in(model, cuts->regions->nodes[region],
                                   hash_unit(sequence.scramble[1] + (uint64_t)k), u);
        struct spot to = spot_on(model->forest, choice.patch, u[2], u[3]);
        if (!(point_kernel(from.at, from.normal, to.at, to.normal) > 0.0))
            continue;
        int32_t own[2] = {from.input, to.input}, guess = -1;
        node->asked++;
        node->seen += !octree_blocks_segment(model->octree, from.at, to.at, own, &guess,
                                             counts) &&
                      !(cuts->panes && is_behind_pane(cuts, &from, &to, choice.patch,
                                                      counts));
    }
}

static void make_cut(struct cuts *cuts, int32_t region, struct octree_counts *counts)
{
    const struct model *model = cuts->senders->model;
    struct bounds bounds = bounds_of(model, cuts->regions->nodes[region]);
    int32_t space = node_space(model, cuts->regions->nodes[region]);
    struct cut *cut = &cuts->cuts[region];
    double most = HUGE_VAL;
    cut->first = cuts->count;
    for (int pass = 0; pass < 2 && cuts->senders->count > 0; pass++) {
        cuts->count = cut->first;
        most = add_nodes(cuts, &bounds, space, 0, most) / cuts->segments;
    }
    cut->count = cuts->count - cut->first;
    double upto = 0.0, seen = 0.5, asked = 1.0;
    for (int64_t i = cut->first; i < cuts->count; i++) {
        ask(cuts, region, &cuts->nodes[i], counts);
        seen += cuts->nodes[i].seen;
        asked += cuts->nodes[i].asked;
    }
    for (int64_t i = cut->first; i < cuts->count; i++) {
        struct cut_node *node = &cuts->nodes[i];
        node->found = node->asked > 0 ? node->seen / node->asked : 0.0;
        node->seen = (node->seen + seen / asked) / (node->asked + 1);
        if (node->found > 0.0)
            node->upto /= cuts_blind_part(
                cuts->senders, &cuts->senders->nodes[node->node], space);
        upto += node->upto * sqrt(node->seen);
        node->upto = upto;
    }
}

struct cut cuts_at(struct cuts *cuts, int32_t leaf, struct octree_counts *counts)
{
    int32_t region = cuts->regions->of[leaf];
    if (region < 0)
        return (struct cut){0, 0};
    if (cuts->cuts[region].first < 0)
        make_cut(cuts, region, counts);
    return cuts->cuts[region];
}

struct choice cuts_choose(const struct cuts *cuts, struct cut cut, double u)
{
    const struct cut_node *nodes = cuts->nodes + cut.first;
    int64_t low = 0, high = cut.count - 1;
    if (cut.count == 0)
        return (struct choice){-1, 0.0};
    double all = nodes[high].upto, at = u * all;
    while (low < high) {
        int64_t middle = low + (high - low) / 2;
        if (nodes[middle].upto > at)
            high = middle;
        else
            low = middle + 1;
    }
    double before = low > 0 ? nodes[low - 1].upto : 0.0, own = nodes[low].upto - before;
    struct choice choice =
        sender_choose(cuts->senders, &cuts->senders->nodes[nodes[low].node],
                      real_min(1.0 - 0x1p-32, (at - before) / own));
    choice.share *= all / own;
    return choice;
}
