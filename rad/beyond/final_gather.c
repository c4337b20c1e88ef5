/* Rows of the final gather.
 *
 * Rays leave a leaf from points spread over it, distributed as the cosine, and each that
 * ends on a front adds 1 / N to the weight of the leaf that it meets. So in a closed
 * scene each row sums to 1, by construction and not by luck. Noise is their only fault,
 * and lamps are where most of it would come from: lamps (rad/beyond/lamps.c) are aimed at
 * by segments, in proportion to the light that they would bring unoccluded, which is
 * known from exact factors; rays that meet a lamp count what it reflects and not what it
 * emits.
 *
 * A leaf is a constant, and a constant is wrong where a ray ends nearer than that leaf is
 * large: under a sheet of paper on a table the table is dark, but the leaf is not. There
 * the ray goes on: the point that it met receives light from a lamp, by one segment, and
 * from one more ray, until a ray ends far enough away. That is a path tracer for what is
 * near and radiosity for the rest.
 *
 * Where it is proved for a root that nothing stands between it and any root that it
 * faces, its leaves need no rays: their rows are exact factors (noise 0). That is so in
 * grooves, between plates and in empty rooms, where the exact answers are.
 *
 * The number of rays grows with the square root of a leaf's area: noise that is counted
 * by area is then least for a given number of all rays.
 *
 * Rejected: exact factors to whatever a leaf sees openly and rays for the rest. Proofs
 * for all pairs cost more than the rays that they save. */
#include "rad/beyond/final_gather.h"

#include <math.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/sequence.h"
#include "rad/pushpull.h"
#include "rad/sample.h"

/* A lamp emits so many times the mean radiosity: then it covers little of what any leaf
 * sees, and where all surfaces are alike, as in a furnace, there is none. */
static const double LAMP = 4.0;

/* A root has exact rows if it faces at most so many times as many roots as rays would be
 * fired. */
enum { FACED_PER_RAY = 4 };

/* A sender is taken as a whole in an exact row if B over its leaves, times its factor and
 * the number of rays, varies by less than this part of the mean: where more rays are
 * asked for, there is more to win. */
static const double VARIES = 0.05;

/* A leaf is too near for a constant if the square of its distance is less than this part
 * of its area. */
static const double NEAR = 0.5;

/* An exact row whose sum is within this of 1 sees no way out. */
static const double CLOSED = 1e-3;

/* Leaves from which on each has fewer rays, and fewest rays of a leaf. */
enum { MANY = 25000, FEWEST = 4 };

/* A path ends after so many points at the latest. */
enum { PATH_MOST = 8, AIMS_MOST = 4, BARE_POINTS = 4 };

/* --- the whole --- */

static double mean_radiosity(const struct method *method)
{
    double sum = 0.0;
    for (int32_t root = 0; root < scene_root_count(method->scene); root++)
        sum += scene_root_area(method->scene, root) *
               rgb_sum(method->forest->patches[root].radiosity);
    return sum / method->area;
}

/* Halves the rays for each fourfold of MANY leaves: what is shown of them together is as
 * smooth as before, and the time grows with the root of their number only. */
static int rays_for(int rays, int64_t leaves)
{
    for (; leaves >= 2 * MANY && rays >= 2 * FEWEST; leaves /= 4)
        rays /= 2;
    return rays;
}

struct final_gather final_gather_create(struct method *method, int rays)
{
    struct forest *forest = method->forest;
    struct final_gather gather = {.method = method, .view = {.root = -1}};
    forest->extremes = alloc_reserve(forest->extremes, &forest->extremes_capacity,
                                     forest->count, sizeof *forest->extremes);
    forest_bound(forest);
    int64_t leaves = forest_leaf_count(forest);
    gather.rays = rays_for(rays, leaves);
    gather.leaf_area = method->area / (double)leaves;
    gather.mean = mean_radiosity(method);
    gather.lamps = lamps_create(method, LAMP * gather.mean);
    gather.order = forest_order(forest);
    gather.place = alloc_array((size_t)forest->count, sizeof *gather.place);
    for (int64_t i = 0; i < forest->count; i++)
        gather.place[gather.order[i]] = (int32_t)i;
    return gather;
}

void final_gather_free(struct final_gather *gather)
{
    lamps_free(&gather->lamps);
    alloc_free(gather->groups.items);
    alloc_free(gather->view.faced);
    alloc_free(gather->order);
    alloc_free(gather->place);
    alloc_free(gather->rows);
    alloc_free(gather->terms);
    *gather = (struct final_gather){0};
}

/* --- rows --- */

/* A row while it is made. */
struct making {
    struct final_gather *gather;
    struct facet leaf;
    struct gather_row row;
    int64_t first;   /* of its terms */
    uint64_t seed;   /* made of the leaf's ID */
    int rays;        /* to be fired */
    int escaped;     /* of them and what follows from them */
    int inside;      /* of them: from points inside of things */
    struct rgb light; /* H that this ray has found, with the solution's radiosities */
    struct rgb sum, squares, half[2]; /* of the light of all rays */
    struct vec3 along;
};

static void add_term(struct making *m, int32_t patch, const struct rgb *weight)
{
    struct final_gather *g = m->gather;
    struct gather_term term = {.place = g->place[patch]};
    struct rgb b = g->method->forest->patches[patch].radiosity;
    for (int c = 0; c < BANDS; c++) {
        term.weight[c] = (float)weight->band[c];
        m->light.band[c] += weight->band[c] * b.band[c];
    }
    g->terms =
        alloc_reserve(g->terms, &g->term_capacity, m->row.end + 1, sizeof *g->terms);
    g->terms[m->row.end++] = term;
}

/* By place, then by weight, so that the order is one that no sorting can change. */
static int compare_terms(const void *left, const void *right)
{
    const struct gather_term *a = left, *b = right;
    int order = (a->place > b->place) - (a->place < b->place);
    for (int c = 0; c < BANDS && order == 0; c++)
        order = (a->weight[c] > b->weight[c]) - (a->weight[c] < b->weight[c]);
    return order;
}

/* Joins the terms of the same patch. */
static void join_terms(struct making *m)
{
    struct gather_term *terms = m->gather->terms;
    int64_t to = m->first;
    qsort(terms + m->first, (size_t)(m->row.end - m->first), sizeof *terms,
          compare_terms);
    for (int64_t i = m->first; i < m->row.end; i++) {
        if (to > m->first && terms[to - 1].place == terms[i].place)
            for (int c = 0; c < BANDS; c++)
                terms[to - 1].weight[c] += terms[i].weight[c];
        else
            terms[to++] = terms[i];
    }
    m->row.end = to;
}

/* A power of two: as many rays as the leaf is worth. */
static int rays_of(const struct final_gather *gather, double area)
{
    int rays = gather->rays;
    double share = area / gather->leaf_area; /* rays^2 grow like the area */
    for (int k = 0; k < 2 && share >= 2.0; k++, share *= 0.25)
        rays *= 2;
    for (int k = 0; k < 2 && share < 0.5; k++, share *= 4.0)
        rays /= 2;
    return rays > FEWEST ? rays : FEWEST;
}

/* --- points that rays meet --- */

struct point {
    int32_t patch;            /* leaf of the forest */
    int32_t input;            /* triangle */
    struct vec3 at, normal;
};

/* The leaf of the root at a point of it. */
static int32_t leaf_at(const struct forest *forest, int32_t root, struct vec3 x)
{
    struct triangle t = scene_root_triangle(forest->scene, root);
    struct vec3 a = vec3_sub(t.corner[1], t.corner[0]);
    struct vec3 b = vec3_sub(t.corner[2], t.corner[0]), to = vec3_sub(x, t.corner[0]);
    struct vec3 normal = vec3_cross(a, b);
    double unit = 1.0 / vec3_dot(normal, normal), w[3]; /* barycentric coordinates */
    w[1] = vec3_dot(vec3_cross(to, b), normal) * unit;
    w[2] = vec3_dot(vec3_cross(a, to), normal) * unit;
    w[0] = 1.0 - w[1] - w[2];
    int32_t p = root;
    while (!patch_is_leaf(&forest->patches[p])) {
        int child = w[0] >= 0.5 ? 0 : w[1] >= 0.5 ? 1 : w[2] >= 0.5 ? 2 : 3;
        for (int k = 0; k < 3; k++)
            w[k] = child == 3 ? 1.0 - 2.0 * w[k] : 2.0 * w[k] - (k == child ? 1.0 : 0.0);
        p = forest->patches[p].children + child;
    }
    return p;
}

enum met { MET_NOTHING, MET_BACK, MET_FRONT };

/* What the ray meets; a front's point is filled in. */
static enum met trace(struct making *m, struct vec3 origin, struct vec3 direction,
                  struct point *point)
{
    const struct method *method = m->gather->method;
    const struct scene *scene = method->scene;
    struct octree_hit hit;
    m->gather->counts.rays++;
    if (!octree_first_hit(method->octree, origin, direction, false, &hit,
                          &m->gather->method->counts))
        return MET_NOTHING;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    if (root < 0 || !(scene_root_area(scene, root) > 0.0))
        return MET_BACK;
    struct plane plane = scene_root_plane(scene, root);
    double fall = -vec3_dot(plane.normal, direction); /* above 0: a front is met */
    double along = fall > 0.0 ? plane_distance(&plane, origin) / fall : 0.0;
    point->at = vec3_add(origin, vec3_scale(direction, along));
    point->patch = leaf_at(method->forest, root, point->at);
    point->input = hit.triangle;
    point->normal = plane.normal;
    return MET_FRONT;
}

/* --- lamps --- */

static void add_source(struct making *m, const struct rgb *weight, struct rgb emission,
                       double factor)
{
    for (int c = 0; c < BANDS; c++) {
        double h = weight->band[c] * factor * emission.band[c];
        m->row.source.band[c] += h;
        m->light.band[c] += h;
    }
}

/* Light of E = 1 that goes from dA at x to dA' at y, for each dA and dA', less
 * visibility; 0 below a horizon. */
static double kernel(struct vec3 x, struct vec3 normal_x, struct vec3 y,
                     struct vec3 normal_y)
{
    static const double PI = 3.14159265358979323846;
    struct vec3 d = vec3_sub(y, x);
    double d2 = vec3_dot(d, d), rise = vec3_dot(normal_x, d),
           fall = -vec3_dot(normal_y, d);
    return rise > 0.0 && fall > 0.0 ? rise * fall / (PI * d2 * d2) : 0.0;
}

static bool sees(struct making *m, struct vec3 from, int32_t input, struct vec3 to,
                 int32_t lamp)
{
    int32_t own[2] = {input, scene_input_of(m->gather->method->scene, lamp)}, guess = -1;
    m->gather->counts.segments++;
    return !octree_blocks_segment(m->gather->method->octree, from, to, own, &guess,
                                  &m->gather->method->counts);
}

/* Of `count` segments that might bring `direct` over all bands a share is seen: the
 * variance of what they bring. */
static void add_chance(struct making *m, struct rgb emission, double direct, double share,
                       int count)
{
    for (int c = 0; c < BANDS; c++) {
        double h = direct * emission.band[c] / rgb_sum(emission);
        m->row.chance[c] += (float)(h * h * share * (1.0 - share) / count);
    }
}

/* Segments to a single lamp: `count` of them bring the irradiance `direct` all together,
 * summed over bands, but for what is blocked: of that each has its kernel's share. */
static void aim_at_lamp(struct making *m, const struct sequence *sequence, uint32_t first,
                        int count, int32_t root, double direct)
{
    static const struct rgb ALL = {{1.0, 1.0, 1.0}};
    const struct scene *scene = m->gather->method->scene;
    struct triangle lamp = scene_root_triangle(scene, root);
    struct vec3 normal = scene_root_plane(scene, root).normal;
    struct rgb emission = scene_root_material(scene, root)->emission;
    double all = 0.0, seen = 0.0, u[SEQUENCE_DIMENSIONS];
    for (int i = 0; i < count; i++) {
        sequence_point(sequence, first + (uint32_t)i, u);
        struct vec3 x = triangle_of_square(&m->leaf.triangle, u[0], u[1]);
        struct vec3 y = triangle_of_square(&lamp, u[2], u[3]);
        double light = kernel(x, m->leaf.plane.normal, y, normal);
        all += light;
        if (light > 0.0 && sees(m, x, m->leaf.input, y, root))
            seen += light;
    }
    if (!(all > 0.0))
        return;
    add_source(m, &ALL, emission, direct * (seen / all) / rgb_sum(emission));
    add_chance(m, emission, direct, seen / all, count);
}

/* One segment to a lamp of a cluster, which is far away: `direct` and `each` are what the
 * group brings, and what one segment stands for. */
static void aim_at_cluster(struct making *m, const struct sequence *sequence,
                           uint32_t index, const struct lamp_group *group, double each)
{
    static const struct rgb ALL = {{1.0, 1.0, 1.0}};
    const struct final_gather *g = m->gather;
    const struct scene *scene = g->method->scene;
    double u[SEQUENCE_DIMENSIONS];
    sequence_point(sequence, index, u);
    struct lamp lamp =
        lamp_choose(&g->lamps, group->node, hash_unit(m->seed + 17 + index));
    struct triangle triangle = scene_root_triangle(scene, lamp.root);
    struct vec3 x = triangle_of_square(&m->leaf.triangle, u[0], u[1]);
    struct vec3 y = triangle_of_square(&triangle, u[2], u[3]);
    double light = kernel(x, m->leaf.plane.normal, y,
                          scene_root_plane(scene, lamp.root).normal);
    if (light > 0.0 && sees(m, x, m->leaf.input, y, lamp.root))
        add_source(m, &ALL, scene_root_material(scene, lamp.root)->emission,
                   light * scene_root_area(scene, lamp.root) * lamp.share *
                       (each / group->direct));
}

/* What lamps bring to the leaf: as many segments as rays, dealt over the groups in
 * proportion to their light. */
static void aim_at_lamps(struct making *m)
{
    struct final_gather *g = m->gather;
    lamps_group(&g->lamps, &m->leaf, &g->groups, &g->method->estimating);
    if (!(g->groups.direct > 0.0))
        return;
    struct sequence sequence = sequence_start(m->seed + 8);
    double each = g->groups.direct / m->rays, sum = 0.0, start = hash_unit(m->seed + 16);
    int done = 0;
    for (int64_t i = 0; i < g->groups.count; i++) {
        const struct lamp_group *group = &g->groups.items[i];
        sum += group->direct;
        int now = (int)fmin(m->rays, floor(sum / each + start)), count = now - done;
        if (!node_is_cluster(group->node) && count > 0)
            aim_at_lamp(m, &sequence, (uint32_t)done, count, group->node, count * each);
        double before = rgb_sum(m->light);
        for (int k = done; k < now && node_is_cluster(group->node); k++)
            aim_at_cluster(m, &sequence, (uint32_t)k, group, each);
        if (node_is_cluster(group->node) && count > 0) {
            int32_t lamp = lamp_choose(&g->lamps, group->node, 0.5).root;
            double share = (rgb_sum(m->light) - before) / (count * each);
            add_chance(m, scene_root_material(g->method->scene, lamp)->emission,
                       count * each, fmin(share, 1.0), count);
        }
        done = now;
    }
}

/* --- paths --- */

/* The light of one lamp at a point beside the leaf; the lamp and a point of it are chosen
 * by hashes. Of a lamp that the horizon cuts, a point above it. */
static void aim_beside(struct making *m, const struct point *x, const struct rgb *weight,
                       uint64_t seed)
{
    const struct final_gather *g = m->gather;
    const struct scene *scene = g->method->scene;
    double at = hash_unit(seed) * g->groups.around;
    int64_t i = 0;
    for (; i < g->groups.count - 1 && at >= g->groups.items[i].around; i++)
        at -= g->groups.items[i].around;
    if (!(g->groups.around > 0.0) || !(g->groups.items[i].around > 0.0))
        return;
    const struct lamp_group *group = &g->groups.items[i];
    struct lamp lamp = lamp_choose(&g->lamps, group->node, hash_unit(seed + 1));
    struct triangle triangle = scene_root_triangle(scene, lamp.root);
    struct vec3 normal = scene_root_plane(scene, lamp.root).normal;
    double factor = point_triangle_factor(x->at, x->normal, &triangle);
    for (uint64_t k = 0; k < AIMS_MOST && factor > 0.0; k++) {
        struct vec3 y = triangle_of_square(&triangle, hash_unit(seed + 2 + 2 * k),
                                       hash_unit(seed + 3 + 2 * k));
        if (!(kernel(x->at, x->normal, y, normal) > 0.0))
            continue;
        if (sees(m, x->at, x->input, y, lamp.root))
            add_source(m, weight, scene_root_material(scene, lamp.root)->emission,
                       factor * lamp.share * (g->groups.around / group->around));
        return;
    }
}

/* True if a leaf is too near to a point, for its size, to be a constant. What counts is
 * its centroid, so that the point sees either all of the leaf as a constant or nothing:
 * where only its far part were one, that would be given the mean of the whole. */
static bool is_too_near(const struct forest *forest, int32_t leaf, struct vec3 x)
{
    struct triangle t = forest_triangle(forest, leaf);
    struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
    return vec3_dot(apart, apart) < NEAR * forest_area(forest, leaf);
}

/* A ray has met a back. Where the floor is covered by a thing that stands on it, a point
 * is inside of that thing, and another ray from there meets a back, too. */
static void look_inside(struct making *m, struct vec3 origin, struct vec3 direction)
{
    struct vec3 normal = m->leaf.plane.normal;
    struct vec3 up = vec3_scale(normal, 2.0 * vec3_dot(normal, direction));
    struct point point;
    if (trace(m, origin, vec3_sub(up, direction), &point) == MET_BACK)
        m->inside++;
    else
        m->escaped++;
}

/* A ray and what follows from it, the seed of which is `seed`. `weight`: of the light
 * that it finds. */
static void follow(struct making *m, struct vec3 origin, struct vec3 direction,
                   struct rgb weight, uint64_t seed)
{
    const struct forest *forest = m->gather->method->forest;
    for (int count = 1;; count++, seed += 16) {
        struct point point;
        enum met met = trace(m, origin, direction, &point);
        if (met == MET_BACK && count == 1)
            look_inside(m, origin, direction);
        else
            m->escaped += met != MET_FRONT;
        if (met != MET_FRONT)
            return;
        const struct material *material = forest_material(forest, point.patch);
        int32_t root = (int32_t)forest->patches[point.patch].id.root;
        bool lamp = root_is_lamp(&m->gather->lamps, root);
        if (count == PATH_MOST || !is_too_near(forest, point.patch, origin)) {
            add_term(m, point.patch, &weight);
            if (lamp)
                add_source(m, &weight, material->emission, -1.0);
            return;
        }
        if (!lamp)
            add_source(m, &weight, material->emission, 1.0);
        for (int c = 0; c < BANDS; c++)
            weight.band[c] *= material->reflectance.band[c];
        if (!(rgb_sum(weight) > 0.0))
            return;
        aim_beside(m, &point, &weight, seed);
        origin = point_above(point.at, point.normal);
        direction = cosine_direction(point.normal, direction_along(point.normal),
                                     hash_unit(seed + 14), hash_unit(seed + 15));
    }
}

/* Enters the light of a ray, of the first half of them or the second, and of what
 * followed. */
static void count_light(struct making *m, int half)
{
    for (int c = 0; c < BANDS; c++) {
        double h = m->light.band[c];
        m->sum.band[c] += h;
        m->squares.band[c] += h * h;
        m->half[half].band[c] += h;
        m->light.band[c] = 0.0;
    }
}

static void fire_rays(struct making *m)
{
    struct sequence sequence = sequence_start(m->seed);
    double share = 1.0 / m->rays, u[SEQUENCE_DIMENSIONS];
    for (int i = 0; i < m->rays; i++) {
        sequence_point(&sequence, (uint32_t)i, u);
        struct vec3 x = triangle_of_square(&m->leaf.triangle, u[2], u[3]);
        follow(m, point_above(x, m->leaf.plane.normal),
               cosine_direction(m->leaf.plane.normal, m->along, u[0], u[1]),
               (struct rgb){{share, share, share}},
               hash_mix(m->seed ^ hash_mix((uint64_t)i)));
        count_light(m, 2 * i / m->rays);
    }
    for (int c = 0; c < BANDS; c++) {
        double mean2 = m->sum.band[c] * m->sum.band[c] / m->rays;
        double apart = m->half[0].band[c] - m->half[1].band[c];
        m->row.chance[c] += (float)fmax(0.0, m->squares.band[c] - mean2);
        m->row.halves[c] = (float)(apart * apart);
    }
    if (m->escaped < m->rays)
        m->gather->counts.escaped += m->escaped;
}

/* The share of the leaf that is met from just above it, and not a face that lies on it: a
 * picture in the plane of a wall, a lamp in that of the ceiling; and that is not inside
 * of things. */
static float bare_share(const struct making *m)
{
    static const double ABOVE = 0x1p-20; /* scene units */
    struct method *method = m->gather->method;
    struct sequence sequence = sequence_start(m->seed + 24);
    struct vec3 normal = m->leaf.plane.normal;
    double u[SEQUENCE_DIMENSIONS];
    int covered = 0;
    for (uint32_t i = 0; i < BARE_POINTS; i++) {
        sequence_point(&sequence, i, u);
        struct vec3 x = triangle_of_square(&m->leaf.triangle, u[0], u[1]);
        struct octree_hit hit;
        covered +=
            octree_first_hit(method->octree, vec3_add(x, vec3_scale(normal, ABOVE)),
                             vec3_scale(normal, -1.0), false, &hit, &method->counts) &&
            hit.triangle != m->leaf.input;
    }
    return (1.0f - (float)covered / BARE_POINTS) *
           (1.0f - (float)m->inside / (float)m->rays);
}

/* --- exact rows --- */

/* Adds the roots below a node that the root faces; false once there are too many. */
static bool view_node(struct final_gather *g, const struct end *root, int32_t node)
{
    struct gather_view *view = &g->view;
    struct end end = end_of(g->method, node);
    if (!ends_may_face(root, &end))
        return true;
    if (end.cluster) {
        bool few = true;
        for (int k = 0; k < 4 && few && end.cluster->child[k] != NODE_NONE; k++)
            few = view_node(g, root, end.cluster->child[k]);
        return few;
    }
    if (view->count == FACED_PER_RAY * g->rays)
        return false;
    view->faced =
        alloc_reserve(view->faced, &view->capacity, view->count + 1, sizeof *view->faced);
    view->faced[view->count++] = node;
    return true;
}

/* True if it is proved that nothing stands between the root and what it faces. Segments
 * come first: most that is hidden is found out by them. */
static bool is_open(struct final_gather *g, const struct facet *root)
{
    const struct octree *octree = g->method->octree;
    struct gather_view *view = &g->view;
    struct vec3 middle = triangle_centroid(&root->triangle);
    int32_t guess = -1;
    bool open = true;
    for (int64_t i = 0; i < view->count && open; i++) {
        struct facet other = facet_make(g->method->forest, view->faced[i]);
        const int32_t own[2] = {root->input, other.input};
        struct vec3 there = triangle_centroid(&other.triangle);
        open = !(kernel(middle, root->plane.normal, there, other.plane.normal) > 0.0) ||
               !octree_blocks_segment(octree, middle, there, own, &guess, &view->counts);
    }
    for (int64_t i = 0; i < view->count && open; i++) {
        struct facet other = facet_make(g->method->forest, view->faced[i]);
        open = facets_are_open(root, &other, octree, &view->counts);
    }
    return open;
}

static const struct gather_view *view_of(struct final_gather *g, int32_t root)
{
    if (g->view.root != root) {
        struct end end = end_of(g->method, root);
        g->view.root = root;
        g->view.count = 0;
        g->view.open = view_node(g, &end, NODE_TOP) && is_open(g, &end.facet);
    }
    return &g->view;
}

/* True if the leaf lies so close on a much larger one that it hides from others what it
 * sees of it: the light of the whole is not what it gets. */
static bool lies_on(const struct making *m, int32_t sender, double factor)
{
    const struct forest *forest = m->gather->method->forest;
    uint32_t root = forest->patches[sender].id.root;
    struct plane plane = scene_root_plane(forest->scene, (int32_t)root);
    double height = plane_distance(&plane, triangle_centroid(&m->leaf.triangle));
    return factor > 0.25 && forest_area(forest, sender) > 4.0 * m->leaf.area &&
           height < 0.25 * triangle_radius(&m->leaf.triangle);
}

/* The exact factor to a patch, or to its leaves where B varies over it. False if one of
 * them cannot be taken for a constant. */
static bool add_exact(struct making *m, int32_t patch)
{
    const struct final_gather *g = m->gather;
    const struct forest *forest = g->method->forest;
    const struct extremes *extremes = &forest->extremes[patch];
    struct triangle sender = forest_triangle(forest, patch);
    double factor = mean_factor(&m->leaf.triangle, m->leaf.plane.normal, &sender,
                                &g->method->estimating);
    double range = (double)extremes->high - (double)extremes->low;
    if (!(factor > 0.0))
        return true;
    bool leaf = patch_is_leaf(&forest->patches[patch]), good = true;
    if (leaf || factor * range * g->rays <= VARIES * g->mean) {
        add_term(m, patch, &(struct rgb){{factor, factor, factor}});
        return !lies_on(m, patch, factor);
    }
    for (int k = 0; k < 4 && good; k++)
        good = add_exact(m, forest->patches[patch].children + k);
    return good;
}

/* False if an exact row has a sum that cannot be true, as where faces lie on each other.
 * One that all but sums to 1 is made to. */
static bool close_row(struct making *m)
{
    struct gather_term *terms = m->gather->terms;
    double sum = 0.0;
    for (int64_t i = m->first; i < m->row.end; i++)
        sum += (double)terms[i].weight[0];
    if (sum > 1.0 + CLOSED)
        return false;
    m->gather->counts.exact++;
    m->gather->counts.escaped += sum > 0.0 && sum < 1.0 - CLOSED;
    for (int64_t i = m->first; i < m->row.end && sum >= 1.0 - CLOSED; i++)
        for (int c = 0; c < BANDS; c++)
            terms[i].weight[c] = (float)((double)terms[i].weight[c] / sum);
    return true;
}

/* False if the root may be hidden from what it faces, or is too close to it. */
static bool make_exact(struct making *m, int32_t root)
{
    const struct gather_view *view = view_of(m->gather, root);
    bool good = view->open;
    for (int64_t i = 0; i < view->count && good; i++)
        good = add_exact(m, view->faced[i]);
    return good && close_row(m);
}

/* --- public --- */

void final_gather_add(struct final_gather *gather, int32_t leaf)
{
    struct making m = {.gather = gather,
                       .leaf = facet_make(gather->method->forest, leaf)};
    struct patch_id id = gather->method->forest->patches[leaf].id;
    m.first = gather->term_count;
    m.row = (struct gather_row){.leaf = leaf, .end = m.first};
    m.seed = hash_mix((uint64_t)id.root << 32 | id.hierarchy);
    m.rays = rays_of(gather, m.leaf.area);
    m.along = direction_along(m.leaf.plane.normal);
    if (!make_exact(&m, (int32_t)id.root)) {
        m.row.end = m.first;
        aim_at_lamps(&m);
        m.light = (struct rgb){{0.0, 0.0, 0.0}};
        fire_rays(&m);
    }
    join_terms(&m);
    m.row.bare = bare_share(&m);
    gather->rows = alloc_reserve(gather->rows, &gather->row_capacity, gather->count + 1,
                                 sizeof *gather->rows);
    gather->rows[gather->count++] = m.row;
    gather->term_count = m.row.end;
}

void final_gather_pull(const struct final_gather *gather, struct rgb *radiosity)
{
    const struct forest *forest = gather->method->forest;
    for (int64_t i = forest->count - 1; i >= 0; i--) {
        const struct patch *patch = &forest->patches[gather->order[i]];
        if (patch_is_leaf(patch))
            continue;
        for (int c = 0; c < BANDS; c++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += radiosity[gather->place[patch->children + k]].band[c];
            radiosity[i].band[c] = 0.25 * sum;
        }
    }
}

struct rgb final_gather_irradiance(const struct final_gather *gather, int64_t row,
                                   const struct rgb *radiosity, bool lamps)
{
    const struct gather_row *at = &gather->rows[row];
    struct rgb h = lamps ? at->source : (struct rgb){{0.0, 0.0, 0.0}};
    for (int64_t i = row > 0 ? at[-1].end : 0; i < at->end; i++)
        for (int c = 0; c < BANDS; c++)
            h.band[c] += (double)gather->terms[i].weight[c] *
                         radiosity[gather->terms[i].place].band[c];
    return h;
}
