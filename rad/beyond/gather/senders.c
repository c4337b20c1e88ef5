/* The tree of senders.
 *
 * The light of a node is estimated as the light of a disc,
 *
 *     H = cos cos' P / (pi (d^2 + r^2)),
 *
 * with its power P, its distance d, and r^2 the sum of the squares of both radii. Cosines
 * are those of the middle, the largest within the bounds of normals; or where the node
 * reaches below a horizon, means over the part above.
 *
 * A bright wall is seldom bright all over: beside a lamp it has a strip, below one a
 * spot. Points all over the wall would seldom be there. So a sender is the largest bright
 * and even patch. */
#include "rad/beyond/gather/senders.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/beyond/sample.h"

/* A patch is even if the mean square of its light is at most this times the square of the
 * mean. */
static const double EVEN = 2.0;

struct bounds facet_bounds(const struct facet *facet)
{
    return (struct bounds){triangle_centroid(&facet->triangle), facet->plane.normal,
                           facet->plane.normal, triangle_radius(&facet->triangle)};
}

struct bounds bounds_of(const struct model *model, int32_t node)
{
    if (node_is_cluster(node)) {
        const struct cluster *cluster = &model->clusters->tree->clusters[~node];
        double radius = 0.5 * vec3_length(vec3_sub(cluster->high, cluster->low));
        return (struct bounds){vec3_middle(cluster->low, cluster->high),
                               cluster->normal_low, cluster->normal_high, radius};
    }
    struct facet facet = facet_make(model->forest, node);
    return facet_bounds(&facet);
}

struct rgb sender_light(const struct senders *senders, int32_t patch)
{
    const struct forest *forest = senders->model->forest;
    if (senders->kind == WINDOWS)
        return senders->sent[patch];
    struct rgb emission = forest_material(forest, patch)->emission;
    return senders->kind == LAMPS ? emission
                                  : rgb_sub(forest->radiosity[patch], emission);
}

/* --- building --- */

struct building {
    struct senders *senders;
    const struct lit *lit;
    double *power; /* [forest->count] of the senders at a patch or below */
    double *before; /* [tree->root_count + 1] of those before a place in the tree */
};

/* The mean square of the light of the patch's leaves, (W/m^2)^2. */
static double mean_square(const struct senders *senders, int32_t patch)
{
    const struct patch *self = &senders->model->forest->patches[patch];
    double sent = rgb_sum(sender_light(senders, patch)), sum = 0.0;
    if (patch_is_leaf(self))
        return sent * sent;
    for (int k = 0; k < 4; k++)
        sum += mean_square(senders, self->children + k);
    return 0.25 * sum;
}

/* A sender of a space sends more than this, over all bands, W/m^2. */
static double least_of(enum sender_kind kind, const struct lit *lit)
{
    return kind == LAMPS ? lit->lamp_least
           : kind == BRIGHT_PATCHES ? lit->bright_least : 0.0;
}

/* Finds the senders in a patch; `part`: the one around the patch, or -1. */
static void find_senders(struct building *b, int32_t patch, int32_t part)
{
    struct senders *senders = b->senders;
    const struct forest *forest = senders->model->forest;
    const struct patch *self = &forest->patches[patch];
    double sent = rgb_sum(sender_light(senders, patch)), below = 0.0;
    bool whole = senders->kind != BRIGHT_PATCHES;
    const struct lit *lit = &b->lit[node_space(senders->model, patch)];
    if (part < 0 && sent > least_of(senders->kind, lit) &&
        (whole || mean_square(senders, patch) <= EVEN * sent * sent))
        part = patch;
    for (int k = 0; k < 4 && !whole && !patch_is_leaf(self); k++) {
        find_senders(b, self->children + k, part);
        below += b->power[self->children + k];
    }
    senders->part_of[patch] = part;
    b->power[patch] = part == patch ? forest_area(forest, patch) * sent : below;
}

static double power_of(const struct building *b, int32_t node)
{
    if (!node_is_cluster(node))
        return b->power[node];
    const struct cluster *cluster =
        &b->senders->model->clusters->tree->clusters[~node];
    return b->before[cluster->end] - b->before[cluster->first];
}

/* Appends a node with senders, and then such nodes below. Returns its number. */
static int32_t add_node(struct building *b, int32_t node)
{
    struct senders *senders = b->senders;
    int32_t number = (int32_t)senders->count++;
    struct sender_node own = {.bounds = bounds_of(senders->model, node),
                              .child = {-1, -1, -1, -1},
                              .space = node_space(senders->model, node),
                              .first = (int32_t)senders->sender_count};
    RESERVE(senders->nodes, &senders->capacity, senders->count);
    bool single = !node_is_cluster(node) && senders->part_of[node] == node;
    if (single) {
        int64_t place = senders->sender_count++;
        RESERVE(senders->patches, &senders->sender_capacity, place + 1);
        RESERVE(senders->before, &senders->before_capacity, place + 2);
        senders->patches[place] = node;
        senders->before[place + 1] = senders->before[place] + b->power[node];
    }
    for (int k = 0, count = 0; k < 4 && !single; k++) {
        int32_t child = node_child(senders->model, node, k);
        if (child == NODE_NONE || !(power_of(b, child) > 0.0))
            continue;
        own.child[count] = add_node(b, child);
        int32_t space = senders->nodes[own.child[count]].space;
        own.space = count++ == 0 || own.space == space ? space : -1;
    }
    own.end = (int32_t)senders->sender_count;
    senders->nodes[number] = own;
    return number;
}

struct senders *senders_create(const struct model *model, enum sender_kind kind,
                               const struct lit *lit, const struct rgb *sent)
{
    const struct cluster_tree *tree = model->clusters->tree;
    size_t patches = (size_t)model->forest->count;
    struct senders *senders = alloc_array(1, sizeof *senders);
    struct building b = {.senders = senders, .lit = lit};
    *senders = (struct senders){.model = model, .kind = kind, .sent = sent};
    b.power = alloc_array(patches, sizeof *b.power);
    b.before = alloc_array((size_t)tree->root_count + 1, sizeof *b.before);
    senders->part_of = alloc_array(patches, sizeof *senders->part_of);
    for (size_t p = 0; p < patches; p++)
        senders->part_of[p] = -1;
    for (int32_t place = 0; place < tree->root_count; place++) {
        find_senders(&b, tree->roots[place], -1);
        b.before[place + 1] = b.before[place] + b.power[tree->roots[place]];
    }
    RESERVE(senders->before, &senders->before_capacity, 1);
    senders->before[0] = 0.0;
    if (b.before[tree->root_count] > 0.0)
        add_node(&b, NODE_TOP);
    alloc_free(b.power);
    alloc_free(b.before);
    return senders;
}

void senders_destroy(struct senders *senders)
{
    if (!senders)
        return;
    alloc_free(senders->nodes);
    alloc_free(senders->patches);
    alloc_free(senders->before);
    alloc_free(senders->part_of);
    alloc_free(senders);
}

/* --- questions --- */

/* The largest product of the vector and a normal within the bounds, or more. */
static double facing_most(const struct bounds *bounds, struct vec3 v)
{
    const struct vec3 *low = &bounds->normal_low, *high = &bounds->normal_high;
    return real_max(low->x * v.x, high->x * v.x) +
           real_max(low->y * v.y, high->y * v.y) + real_max(low->z * v.z, high->z * v.z);
}

/* The mean of the heights above 0 of a node at this height, reaching as far above as
 * below; heights below 0 count as 0. */
static double mean_above(double height, double reach)
{
    double top = height + reach;
    return height >= reach ? height : 0.25 * top * top / reach;
}

double sender_node_worth(const struct senders *senders, const struct sender_node *node,
                         const struct bounds *to)
{
    struct vec3 apart = vec3_sub(node->bounds.middle, to->middle);
    double reach = node->bounds.radius + to->radius;
    double rise = facing_most(to, apart);
    double fall = facing_most(&node->bounds, vec3_scale(apart, -1.0));
    if (rise + reach <= 0.0 || fall + reach <= 0.0)
        return 0.0;
    double distance2 = vec3_dot(apart, apart), distance = sqrt(distance2);
    double cosines = real_min(1.0, mean_above(rise, reach) / distance) *
                     real_min(1.0, mean_above(fall, reach) / distance);
    double wide2 = distance2 + node->bounds.radius * node->bounds.radius +
                   to->radius * to->radius;
    return cosines * (senders->before[node->end] - senders->before[node->first]) /
           (PI * wide2);
}

struct choice sender_choose(const struct senders *senders, const struct sender_node *node,
                            double u)
{
    const double *before = senders->before;
    double all = before[node->end] - before[node->first];
    int64_t place = node->first + sum_place(before + node->first + 1,
                                            node->end - node->first,
                                            before[node->first] + u * all);
    return (struct choice){senders->patches[place],
                           all / (before[place + 1] - before[place])};
}
