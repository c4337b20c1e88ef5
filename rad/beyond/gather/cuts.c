/* Cuts.
 *
 * From the top of the tree downwards, a node is in the cut as soon as it is small for
 * its distance and would get no more than one segment, if these were dealt by light.
 *
 * The visible shares decide only how segments are dealt, and how unsure a leaf is after
 * finding nothing; no share stands for light itself. Of a node that k of n segments reach
 * the share is taken for (k + m) / (n + 1), with the mean share m of all nodes of the
 * cut: so no share is 0, and a node behind a wall with a window counts for less than one
 * behind a leg of a chair. If nodes without a segment had shares of 0, segments would go
 * where others have gone: looks would be noisy, and ten times as many leaves split.
 *
 * Segments are counted by each rank and added up between rounds of looks. */
#include "rad/beyond/gather/cuts.h"

#include <math.h>

#include "geom/alloc.h"

/* Leaves of a region, at most; nodes of cuts kept, about, where few come back. */
enum { REGION_LEAVES = 16, NODES_KEPT = 16384 };

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
    regions->known = model->forest->count;
    RESERVE(regions->of, &regions->known_capacity, regions->known);
    for (int64_t p = 0; p < model->forest->count; p++)
        regions->of[p] = -1;
    for (int32_t place = 0; place < tree->root_count; place++)
        before[place + 1] = before[place] + leaves_of(model->forest, tree->roots[place]);
    name_leaves(regions, model, NODE_TOP, before, -1);
    alloc_free(before);
    return regions;
}

void regions_follow(struct regions *regions, const struct forest *forest)
{
    RESERVE(regions->of, &regions->known_capacity, forest->count);
    for (; regions->known < forest->count; regions->known++)
        regions->of[regions->known] =
            regions->of[forest->patches[regions->known].parent];
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
                         int segments)
{
    struct cuts *cuts = alloc_array(1, sizeof *cuts);
    cuts->senders = senders;
    cuts->regions = regions;
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
    alloc_free(cuts->tally);
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

/* What a cut is made for. */
struct region {
    int32_t number, space;
    struct bounds bounds;
};

/* Appends the nodes of a cut below a node. `most`: light of one of these, at most, W/m^2.
 * Returns the light of all. */
static double add_nodes(struct cuts *cuts, const struct region *region, int32_t number,
                        double most)
{
    const struct sender_node *node = &cuts->senders->nodes[number];
    const struct bounds *to = &region->bounds;
    double light = sender_node_worth(cuts->senders, node, to);
    double worth = light * cuts_blind_part(cuts->senders, node, region->space);
    double sum = 0.0;
    if (!(worth > 0.0))
        return 0.0;
    struct vec3 apart = vec3_sub(node->bounds.middle, to->middle);
    double reach = node->bounds.radius + to->radius;
    double far = real_max(vec3_length(apart) - reach, to->radius);
    bool small = node->bounds.radius <= SMALL * far && node->space >= 0;
    if (node->child[0] < 0 || (small && worth <= most)) {
        RESERVE(cuts->nodes, &cuts->capacity, cuts->count + 1);
        cuts->nodes[cuts->count++] = (struct cut_node){
            .node = number, .region = region->number, .worth = light};
        return worth;
    }
    for (int k = 0; k < 4 && node->child[k] >= 0; k++)
        sum += add_nodes(cuts, region, node->child[k], most);
    return sum;
}

double cut_seen(const struct cut *cut, const struct cut_node *node)
{
    return (node->arrived + cut->mean) / (node->asked + 1.0);
}

double cut_found(const struct cut *cut, const struct cut_node *node, double blind)
{
    if (node->asked > 0)
        return (double)node->arrived / node->asked;
    return blind < 1.0 ? 0.0 : cut_seen(cut, node);
}

/* Finds the shares of the nodes of a region's cut by the segments counted so far. */
static void find_shares(struct cuts *cuts, int32_t region)
{
    struct cut *cut = &cuts->cuts[region];
    int32_t space = node_space(cuts->senders->model, cuts->regions->nodes[region]);
    int64_t end = cut->first + cut->count;
    double upto = 0.0, arrived = 0.5, asked = 1.0;
    for (int64_t i = cut->first; i < end; i++) {
        arrived += cuts->nodes[i].arrived;
        asked += cuts->nodes[i].asked;
    }
    cut->mean = arrived / asked;
    for (int64_t i = cut->first; i < end; i++) {
        struct cut_node *node = &cuts->nodes[i];
        const struct sender_node *at = &cuts->senders->nodes[node->node];
        double light = node->worth;
        if (node->arrived == 0)
            light *= cuts_blind_part(cuts->senders, at, space);
        upto += light * sqrt(cut_seen(cut, node));
        node->upto = upto;
    }
}

static void make_cut(struct cuts *cuts, int32_t number)
{
    const struct model *model = cuts->senders->model;
    int32_t node = cuts->regions->nodes[number];
    struct region region = {number, node_space(model, node), bounds_of(model, node)};
    struct cut *cut = &cuts->cuts[number];
    double most = HUGE_VAL;
    *cut = (struct cut){.first = cuts->count};
    for (int pass = 0; pass < 2 && cuts->senders->count > 0; pass++) {
        cuts->count = cut->first;
        most = add_nodes(cuts, &region, 0, most) / cuts->segments;
    }
    cut->count = cuts->count - cut->first;
}

void cuts_make(struct cuts *cuts, int64_t first, int64_t end)
{
    for (int64_t region = first; region < end; region++)
        if (cuts->cuts[region].first < 0)
            make_cut(cuts, (int32_t)region);
}

void cuts_take(struct cuts *cuts, struct cut_node *nodes, int64_t count)
{
    alloc_free(cuts->nodes);
    cuts->nodes = nodes;
    cuts->capacity = cuts->count = count;
    int64_t end = 0;
    for (int32_t region = 0; region < cuts->regions->count; region++) {
        int64_t first = end;
        while (end < count && nodes[end].region == region)
            end++;
        cuts->cuts[region] = (struct cut){.first = first, .count = end - first};
    }
}

void cuts_count(struct cuts *cuts)
{
    cuts_make(cuts, 0, cuts->regions->count);
    cuts->tally = alloc_array(2 * (size_t)cuts->count, sizeof *cuts->tally);
}

void cuts_learn(struct cuts *cuts)
{
    for (int64_t i = 0; i < cuts->count; i++) {
        struct cut_node *node = &cuts->nodes[i];
        if (cuts->tally[2 * i] <= INT32_MAX - node->asked) { /* else it is known well */
            node->asked += (int32_t)cuts->tally[2 * i];
            node->arrived += (int32_t)cuts->tally[2 * i + 1];
        }
        cuts->tally[2 * i] = cuts->tally[2 * i + 1] = 0;
    }
    for (int64_t region = 0; region < cuts->regions->count; region++)
        cuts->cuts[region].mean = 0.0;
}

void cuts_limit(struct cuts *cuts)
{
    if (cuts->count <= NODES_KEPT)
        return;
    for (int64_t i = 0; i < cuts->regions->count; i++)
        cuts->cuts[i].first = -1;
    cuts->count = 0;
}

struct cut cuts_at(struct cuts *cuts, int32_t leaf)
{
    int32_t region = cuts->regions->of[leaf];
    if (region < 0)
        return (struct cut){0, 0, 1.0};
    if (cuts->cuts[region].first < 0)
        make_cut(cuts, region);
    if (cuts->cuts[region].mean == 0.0)
        find_shares(cuts, region);
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
