/* Lamps as a leaf sees them.
 *
 * From the top of the tree downwards, a cluster is one group as soon as it is small for
 * its distance and would get no more than one segment, or a sixteenth of one if some of
 * its lamps may face away; a lamp by itself is a group whose direct light is known from
 * exact factors. So a hall with ten thousand lamps has some hundreds of groups for each
 * leaf. How much light one segment is to bring is estimated first, without exact factors.
 * Light that walls may keep off counts for no more than comes to the leaf as the links
 * have it. Of bright patches, a root with some below it is told apart in the same way.
 * Their direct light decides only how often rays are aimed at them: an estimate is
 * enough.
 *
 * The mean factor is taken at three points with a rule that is exact for polynomials of
 * the second degree. Where the other triangle is nearer than the size of this one, the
 * four quarters of this one are taken, and theirs, three times at most: then the points
 * are a sixteenth of its size apart. That finds nothing of light that gets out of a gap
 * narrower than this: across a gap the factor is the exact one of both triangles. */
#include "rad/beyond/lamps.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/contour.h"
#include "geom/lambert.h"
#include "rad/beyond/sample.h"

/* A cluster is a group if its radius is at most this part of its distance; and for a
 * first estimate of all light. */
static const double SMALL = 0.25, SMALL_AT_FIRST = 3.0;

/* A lamp is chosen by its exact light if the square of its distance is less than this
 * times its area; levels below a near cluster that are looked at. */
static const double EXACT_WITHIN = 16.0;
enum { LOOKED = 2 };

/* A cluster of which some lamps may face the leaf and others not brings all or nothing by
 * a segment: it is a group if it would get this part of one. */
static const double PART_OF_MIXED = 1.0 / 16.0;

/* Least cosine that a group of lamps is counted with: where a part of it may be above the
 * horizon, it has to be chosen now and then. */
static const double LEAST_COSINE = 0.1;

/* The part of all segments that go to groups by their light without blockers. */
static const double DEFENSIVE = 0.25;

/* A bright patch is even: the mean square of its light is at most this times the square
 * of the mean, as if it all came from the inverse of this part. */
static const double EVEN = 2.0;

enum { QUARTERINGS = 3 };

/* Tests that take about as long as the exact factor of two triangles. */
enum { TESTS_PER_EXACT_FACTOR = 400 };

/* --- factors --- */

static double factor_of_points(const struct triangle *from, struct vec3 normal,
                               const struct triangle *to, int64_t *work)
{
    struct vec3 x[3];
    double factor = 0.0;
    triangle_three_points(from, x);
    for (int k = 0; k < 3; k++)
        factor += point_triangle_factor(x[k], normal, to) / 3.0;
    *work += 3 * TESTS_PER_FORM_FACTOR;
    return factor;
}

/* From a point to the box around a triangle, squared. */
static double distance2_to_box(struct vec3 x, const struct triangle *t)
{
    struct vec3 below = vec3_sub(triangle_low(t), x);
    struct vec3 above = vec3_sub(x, triangle_high(t));
    struct vec3 none = {0.0, 0.0, 0.0};
    struct vec3 apart = vec3_most(none, vec3_most(below, above));
    return vec3_dot(apart, apart);
}

static bool is_near(const struct triangle *from, const struct triangle *to)
{
    double size = triangle_radius(from);
    return distance2_to_box(triangle_centroid(from), to) <= 4.0 * size * size;
}

static bool is_across_gap(const struct triangle *from, struct vec3 normal,
                          const struct triangle *to)
{
    struct plane plane = triangle_plane(to);
    double width = plane_distance(&plane, triangle_centroid(from));
    return gap_is_narrow(normal, plane.normal, width, triangle_area(from));
}

static double factor_of_quarters(const struct triangle *from, struct vec3 normal,
                                 const struct triangle *to, int quarterings,
                                 int64_t *work)
{
    if (quarterings == 0 || !is_near(from, to))
        return factor_of_points(from, normal, to, work);
    double factor = 0.0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(from, k);
        factor += 0.25 * factor_of_quarters(&child, normal, to, quarterings - 1, work);
    }
    return factor;
}

double near_factor(const struct triangle *from, struct vec3 normal,
                   const struct triangle *to, int64_t *work)
{
    if (!is_near(from, to))
        return factor_of_points(from, normal, to, work);
    *work += TESTS_PER_EXACT_FACTOR;
    return triangle_exchange(from, to) / triangle_area(from);
}

double mean_factor(const struct triangle *from, struct vec3 normal,
                   const struct triangle *to, int64_t *work)
{
    if (!(triangle_radius(from) > 0.0)) { /* a point */
        *work += TESTS_PER_FORM_FACTOR;
        return point_triangle_factor(from->corner[0], normal, to);
    }
    if (is_near(from, to) && is_across_gap(from, normal, to))
        return near_factor(from, normal, to, work);
    return factor_of_quarters(from, normal, to, QUARTERINGS, work);
}

/* --- lamps --- */

struct rgb lamp_light(const struct lamps *lamps, int32_t patch)
{
    const struct forest *forest = lamps->model->forest;
    struct rgb emission = forest_material(forest, patch)->emission;
    return lamps->reflect ? rgb_sub(forest->radiosity[patch], emission) : emission;
}

void lamps_places(const struct lamps *lamps, int32_t node, int32_t *first, int32_t *end)
{
    const struct cluster_tree *tree = lamps->model->clusters->tree;
    const struct cluster *cluster = node_is_cluster(node) ? &tree->clusters[~node] : NULL;
    *first = cluster ? cluster->first : tree->place[node];
    *end = cluster ? cluster->end : *first + 1;
}

static double watts_of(const struct lamps *lamps, int32_t node)
{
    int32_t first, end;
    lamps_places(lamps, node, &first, &end);
    return lamps->before[end] - lamps->before[first];
}

/* Appends a cluster that has lamps, and then those below it. Returns it as a child. */
static int32_t add_lit(struct lamps *lamps, int32_t node)
{
    const struct cluster *cluster = &lamps->model->clusters->tree->clusters[~node];
    int32_t number = (int32_t)lamps->lit_count++, count = 0;
    struct lit_cluster lit = {
        node, {NODE_NONE, NODE_NONE, NODE_NONE, NODE_NONE}, watts_of(lamps, node),
        vec3_middle(cluster->low, cluster->high), cluster->normal_low,
        cluster->normal_high, 0.5 * vec3_length(vec3_sub(cluster->high, cluster->low))};
    RESERVE(lamps->lit, &lamps->lit_capacity, lamps->lit_count);
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++) {
        int32_t child = cluster->child[k];
        if (watts_of(lamps, child) > 0.0)
            lit.child[count++] = node_is_cluster(child) ? add_lit(lamps, child) : child;
    }
    lamps->lit[number] = lit;
    return ~number;
}

/* The mean square of the light that leaves of the patch send, (W/m^2)^2. */
static double mean_square(const struct lamps *lamps, int32_t patch)
{
    const struct patch *self = &lamps->model->forest->patches[patch];
    double sent = rgb_sum(lamp_light(lamps, patch)), sum = 0.0;
    if (patch_is_leaf(self))
        return sent * sent;
    for (int k = 0; k < 4; k++)
        sum += mean_square(lamps, self->children + k);
    return 0.25 * sum;
}

/* True if most of the patch, which sends so much, sends about that: the mean of a wall
 * may be bright because of a spot or a strip of it beside a lamp. Points on all of the
 * wall would seldom be there, and leaves near the wall would not aim at it at all. */
static bool is_even(const struct lamps *lamps, int32_t patch, double sent)
{
    return mean_square(lamps, patch) <= EVEN * sent * sent;
}

/* Finds the bright patches in a patch; `part`: the one that it is part of, or -1. Returns
 * their power. */
static double find_bright(struct lamps *lamps, int32_t patch, int32_t part)
{
    const struct forest *forest = lamps->model->forest;
    int32_t first = forest->patches[patch].children;
    double sent = rgb_sum(lamp_light(lamps, patch)), below = 0.0;
    if (part < 0 && sent > lamps->least && is_even(lamps, patch, sent))
        part = patch;
    for (int k = 0; k < 4 && !patch_is_leaf(&forest->patches[patch]); k++)
        below += find_bright(lamps, first + k, part);
    lamps->part_of[patch] = part;
    lamps->power[patch] = part == patch ? forest_area(forest, patch) * sent : below;
    return lamps->power[patch];
}

/* What a root sends, by the power of its bright patches. */
static double sent_by_bright(struct lamps *lamps, int32_t root)
{
    return find_bright(lamps, root, -1) / scene_root_area(lamps->model->scene, root);
}

struct lamps lamps_create(const struct model *model, double least, bool reflect)
{
    const struct cluster_tree *tree = model->clusters->tree;
    size_t patches = (size_t)model->forest->count;
    struct lamps lamps = {.model = model, .least = least, .reflect = reflect,
                          .alike = true};
    const struct material *first = NULL;
    int32_t roots = scene_root_count(model->scene);
    lamps.sent = alloc_array((size_t)roots, sizeof *lamps.sent);
    lamps.before = alloc_array((size_t)tree->root_count + 1, sizeof *lamps.before);
    if (reflect) {
        lamps.power = alloc_array(patches, sizeof *lamps.power);
        lamps.part_of = alloc_array(patches, sizeof *lamps.part_of);
    }
    for (int32_t place = 0; place < tree->root_count; place++) {
        int32_t root = tree->roots[place];
        double sent = reflect ? sent_by_bright(&lamps, root)
                              : rgb_sum(lamp_light(&lamps, root));
        lamps.sent[root] = reflect || sent > least ? sent : 0.0;
        if (sent > least) {
            const struct material *m = scene_root_material(model->scene, root);
            first = first ? first : m;
            for (int c = 0; c < BANDS; c++)
                lamps.alike =
                    lamps.alike && m->emission.band[c] == first->emission.band[c];
        }
        lamps.before[place + 1] =
            lamps.before[place] + scene_root_area(model->scene, root) * lamps.sent[root];
    }
    if (lamps_power(&lamps) > 0.0)
        add_lit(&lamps, NODE_TOP);
    return lamps;
}

void lamps_free(struct lamps *lamps)
{
    alloc_free(lamps->groups.items);
    alloc_free(lamps->sent);
    alloc_free(lamps->before);
    alloc_free(lamps->power);
    alloc_free(lamps->part_of);
    alloc_free(lamps->lit);
}

double lamps_power(const struct lamps *lamps)
{
    return lamps->before[lamps->model->clusters->tree->root_count];
}

/* --- groups --- */

/* The leaf that lamps are grouped for. */
struct lit {
    const struct facet *facet;
    struct vec3 centroid;
    double radius;
    double small; /* a group's radius over its distance, at most */
    double each;  /* a cluster's direct light, at most, if it is a group, W/m^2 */
    double most;  /* worth of the lamps of a node below the top, at most, W/m^2 */
};

static void sum_up(struct lamp_groups *groups, int64_t first)
{
    groups->worth = 0.0;
    for (int64_t i = first; i < groups->count; i++)
        groups->worth += groups->items[i].worth;
}

/* Makes the groups from number `first` on, those of a node, worth no more than `most`. */
static void limit(struct lamp_groups *groups, int64_t first, double most)
{
    sum_up(groups, first);
    double part = real_min(1.0, most / groups->worth);
    for (int64_t i = first; i < groups->count; i++)
        groups->items[i].worth *= part;
}

static void add_group(struct lamp_groups *groups, struct lamp_group group)
{
    group.worth = group.direct;
    group.seen = 1.0;
    RESERVE(groups->items, &groups->capacity, groups->count + 1);
    groups->items[groups->count++] = group;
}

/* About the cosine between a plane's normal and the way to a lamp. */
static double cosine_to(const struct plane *plane, struct vec3 apart, double distance2)
{
    return real_max(vec3_dot(apart, plane->normal) / sqrt(distance2), LEAST_COSINE);
}

/* The largest product of the vector and a normal of the cluster, or more. */
static double facing_most(const struct lit_cluster *cluster, struct vec3 v)
{
    const struct vec3 *low = &cluster->normal_low, *high = &cluster->normal_high;
    return real_max(low->x * v.x, high->x * v.x) +
           real_max(low->y * v.y, high->y * v.y) + real_max(low->z * v.z, high->z * v.z);
}

static void add_child(const struct lamps *lamps, const struct lit *leaf, int32_t child,
                      struct lamp_groups *groups, int64_t *work);

/* Adds a cluster as a group, or those below it. */
static void add_cluster(const struct lamps *lamps, const struct lit *leaf,
                        const struct lit_cluster *cluster, struct lamp_groups *groups,
                        int64_t *work)
{
    const struct plane *plane = &leaf->facet->plane;
    struct vec3 apart = vec3_sub(cluster->middle, leaf->centroid);
    double distance2 = vec3_dot(apart, apart), distance = sqrt(distance2);
    double facing = facing_most(cluster, vec3_scale(apart, -1.0));
    double reach = cluster->radius + leaf->radius;
    struct lamp_group group = {.node = cluster->node};
    if (facing + reach <= 0.0 || vec3_dot(apart, plane->normal) + reach <= 0.0)
        return;
    if (cluster->radius <= leaf->small * real_max(distance - reach, leaf->radius)) {
        facing = real_min(1.0, real_max(facing / distance, LEAST_COSINE));
        group.direct = cosine_to(plane, apart, distance2) * facing * cluster->watts /
                       real_max(PI * distance2, leaf->facet->area);
        bool mixed = facing_most(cluster, apart) + reach > 0.0;
        if (group.direct <= (mixed ? PART_OF_MIXED : 1.0) * leaf->each) {
            add_group(groups, group);
            return;
        }
    }
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++)
        add_child(lamps, leaf, cluster->child[k], groups, work);
}

/* Adds a patch that is bright, or has bright ones below it and is small for its distance,
 * as a group; or those below it. Their light is estimated. */
static void add_patch(const struct lamps *lamps, const struct lit *leaf, int32_t patch,
                      const struct facet *facet, struct lamp_groups *groups)
{
    const struct patch *self = &lamps->model->forest->patches[patch];
    if (!facets_face(leaf->facet, facet))
        return;
    struct vec3 apart = vec3_sub(triangle_centroid(&facet->triangle), leaf->centroid);
    double distance2 = real_max(vec3_dot(apart, apart), facet->area);
    double radius = triangle_radius(&facet->triangle), power = lamps->power[patch];
    bool bright = lamps->part_of[patch] == patch;
    if (bright || radius * radius <= leaf->small * leaf->small * distance2) {
        struct lamp_group group = {.node = patch};
        group.direct = real_min(power / (PI * distance2), power / facet->area) *
                       cosine_to(&leaf->facet->plane, apart, distance2) *
                       cosine_to(&facet->plane, vec3_scale(apart, -1.0), distance2);
        if (bright || group.direct <= leaf->each) {
            add_group(groups, group);
            return;
        }
    }
    struct facet child = *facet;
    child.area *= 0.25;
    for (int32_t k = 0; k < 4; k++)
        if (lamps->power[self->children + k] > 0.0) {
            child.triangle = triangle_child(&facet->triangle, k);
            add_patch(lamps, leaf, self->children + k, &child, groups);
        }
}

/* Adds a lamp as a group. `work` NULL: its direct light is estimated. */
static void add_root(const struct lamps *lamps, const struct lit *leaf, int32_t root,
                     struct lamp_groups *groups, int64_t *work)
{
    struct facet lamp = facet_make(lamps->model->forest, root);
    struct vec3 apart = vec3_sub(triangle_centroid(&lamp.triangle), leaf->centroid);
    double sent = lamps->sent[root];
    double distance2 = real_max(vec3_dot(apart, apart), lamp.area);
    struct lamp_group group = {.node = root};
    double around = sent * real_min(1.0, lamp.area / (PI * distance2));
    if (facets_face(leaf->facet, &lamp) && !work)
        group.direct = around * cosine_to(&leaf->facet->plane, apart, distance2) *
                       cosine_to(&lamp.plane, vec3_scale(apart, -1.0), distance2);
    else if (facets_face(leaf->facet, &lamp))
        group.direct = sent * mean_factor(&leaf->facet->triangle,
                                          leaf->facet->plane.normal, &lamp.triangle,
                                          work);
    add_group(groups, group);
}

static void add_child(const struct lamps *lamps, const struct lit *leaf, int32_t child,
                      struct lamp_groups *groups, int64_t *work)
{
    int64_t first = groups->count;
    if (child < 0) {
        add_cluster(lamps, leaf, &lamps->lit[~child], groups, work);
    } else if (lamps->reflect) {
        struct facet root = facet_make(lamps->model->forest, child);
        add_patch(lamps, leaf, child, &root, groups);
    } else {
        add_root(lamps, leaf, child, groups, work);
    }
    limit(groups, first, leaf->most);
}

/* Gives a part of all worth to groups by their direct light: links may be wrong, and a
 * bright lamp that is rarely chosen would count many times as much. */
static void spread_worth(struct lamp_groups *groups)
{
    double direct = 0.0;
    for (int64_t i = 0; i < groups->count; i++)
        direct += groups->items[i].direct;
    for (int64_t i = 0; i < groups->count && direct > 0.0; i++) {
        struct lamp_group *group = &groups->items[i];
        double even = groups->worth * (group->direct / direct);
        group->worth += DEFENSIVE * (even - group->worth);
    }
}

void lamps_group(struct lamps *lamps, const struct facet *leaf, int segments, double most,
                 int64_t *work)
{
    struct lamp_groups *groups = &lamps->groups;
    struct lit lit = {.facet = leaf, .centroid = triangle_centroid(&leaf->triangle),
                      .radius = triangle_radius(&leaf->triangle),
                      .small = SMALL_AT_FIRST, .each = HUGE_VAL, .most = most};
    for (int pass = 0; pass < 2; pass++) {
        groups->count = 0;
        if (lamps->lit_count > 0)
            add_cluster(lamps, &lit, lamps->lit, groups, pass == 0 ? NULL : work);
        sum_up(groups, 0);
        lit.small = SMALL;
        lit.each = groups->worth / segments;
    }
    spread_worth(groups);
}

/* Of the bright patches in a patch, in turn, the one at which the power of those before
 * it reaches `at`. */
static int32_t bright_at(const struct lamps *lamps, int32_t patch, double at)
{
    const struct forest *forest = lamps->model->forest;
    while (lamps->part_of[patch] != patch) {
        int32_t first = forest->patches[patch].children;
        for (int32_t child = first; child < first + 4; child++) {
            if (!(lamps->power[child] > 0.0))
                continue;
            patch = child;
            if (at < lamps->power[child])
                break;
            at -= lamps->power[child];
        }
    }
    return patch;
}

struct lamp lamp_choose(const struct lamps *lamps, int32_t node, double u)
{
    const struct cluster_tree *tree = lamps->model->clusters->tree;
    int32_t first, end;
    if (lamps->reflect && !node_is_cluster(node)) {
        int32_t patch = bright_at(lamps, node, u * lamps->power[node]);
        return (struct lamp){patch, lamps->power[node] / lamps->power[patch]};
    }
    lamps_places(lamps, node, &first, &end);
    double all = lamps->before[end] - lamps->before[first];
    double at = lamps->before[first] + u * all;
    first += (int32_t)sum_place(lamps->before + first + 1, end - first, at);
    while (lamps->before[first + 1] == lamps->before[first]) /* no lamp: by rounding */
        first--;
    int32_t patch = tree->roots[first];
    double own = lamps->before[first + 1] - lamps->before[first];
    if (lamps->reflect) {
        patch = bright_at(lamps, patch, at - lamps->before[first]);
        own = lamps->power[patch];
    }
    return (struct lamp){patch, all / own};
}

/* The irradiance of a point x that lamps of so much power may bring, about, W/m^2: they
 * face it by `facing` and are above its horizon by `up`, scene units; near ones may do so
 * at any angle. */
static double worth_of(double watts, struct vec3 apart, double radius, double facing,
                       double up)
{
    double distance2 = vec3_dot(apart, apart);
    if (!(facing > 0.0 && up > 0.0))
        return 0.0;
    if (distance2 < 4.0 * radius * radius)
        return watts / (PI * real_max(distance2, radius * radius));
    double distance = sqrt(distance2);
    return watts / (PI * distance2) *
           real_min(1.0, real_max(facing / distance, LEAST_COSINE)) *
           real_min(1.0, real_max(up / distance, LEAST_COSINE));
}

/* The same, of a node; of a cluster that is near, its children's, so many levels down. A
 * lamp that is near tells exactly. */
static double worth_at(const struct lamps *lamps, int32_t node, struct vec3 x,
                       struct vec3 normal, int levels)
{
    if (node >= 0) {
        const struct scene *scene = lamps->model->scene;
        struct triangle t = scene_root_triangle(scene, node);
        struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
        double area = scene_root_area(scene, node);
        if (vec3_dot(apart, apart) < EXACT_WITHIN * area)
            return lamps->sent[node] * point_triangle_factor(x, normal, &t);
        struct plane plane = scene_root_plane(scene, node);
        double radius = triangle_radius(&t);
        return worth_of(lamps->sent[node] * area, apart, radius,
                        plane_distance(&plane, x), vec3_dot(apart, normal) + radius);
    }
    const struct lit_cluster *cluster = &lamps->lit[~node];
    struct vec3 apart = vec3_sub(cluster->middle, x);
    double sum = 0.0, radius = cluster->radius;
    if (levels == 0 || vec3_dot(apart, apart) >= 4.0 * radius * radius)
        return worth_of(cluster->watts, apart, radius,
                        facing_most(cluster, vec3_scale(apart, -1.0)) + radius,
                        vec3_dot(apart, normal) + radius);
    for (int k = 0; k < 4 && cluster->child[k] != NODE_NONE; k++)
        sum += worth_at(lamps, cluster->child[k], x, normal, levels - 1);
    return sum;
}

struct lamp lamp_choose_at(const struct lamps *lamps, struct vec3 x, struct vec3 normal,
                           double most, double u)
{
    static const struct lamp NONE = {-1, 0.0};
    double share = 1.0;
    int32_t child = ~0;
    if (lamps->lit_count == 0)
        return NONE;
    while (child < 0) {
        const struct lit_cluster *cluster = &lamps->lit[~child];
        double worth[4], sum = 0.0;
        int count = 0, k = 0;
        for (; count < 4 && cluster->child[count] != NODE_NONE; count++) {
            worth[count] =
                real_min(most, worth_at(lamps, cluster->child[count], x, normal,
                                        LOOKED));
            sum += worth[count];
        }
        if (!(sum > 0.0))
            return NONE;
        double at = u * sum;
        for (; k < count - 1 && at >= worth[k]; k++)
            at -= worth[k];
        while (!(worth[k] > 0.0)) /* by rounding */
            k--;
        u = at / worth[k];
        share *= sum / worth[k];
        child = cluster->child[k];
    }
    return (struct lamp){child, share};
}
