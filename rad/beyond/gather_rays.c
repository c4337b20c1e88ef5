/* Rays of the final gather.
 *
 * Rays leave a receiver from points spread over it, distributed as the cosine, and each
 * that ends on a front adds 1 / N to the weight of the leaf that it meets. So in a closed
 * scene each row sums to 1, by construction and not by luck. Noise is their only fault,
 * and lamps are where most of it would come from: lamps (rad/beyond/lamps.c) are aimed at
 * by segments, in proportion to the light that they would bring unoccluded, which is
 * known from exact factors; rays that meet a lamp count its reflected light and not its
 * emission.
 *
 * Next come bright roots, those that reflect more than a lamp emits at least: the inside
 * of a lamp's housing sends a tenth of the light of a furnished room and brings most of
 * the variance, as one ray in 500 meets it. Rays are aimed at them, too. A ray that was
 * not, and meets one, is put aside, and the others stand for all directions but those
 * of bright roots,
 *
 *     H = sum over aimed rays of F B  +  (1 - sum of F) * mean of B over the others,
 *
 * so rows still sum to 1. Beside a bright root all this does not apply: rays find it
 * often enough, and factors of a few points of it would vary without bound.
 *
 * The mesh is wrong where a ray ends nearer than the leaf there is large: under a
 * sheet of paper on a table the table is dark, but the leaf is not. And it is wrong in
 * a gap that is narrow for the leaf, also far from where the ray began: the leaf may
 * reach into the light. It is wrong, too, where a box stands on part of a leaf: pictures
 * know such leaves. There the ray goes on: the point that it met receives light from a
 * lamp, by one segment, and from one more ray, until a ray ends far enough away. That is
 * a path tracer for near surfaces and radiosity for the rest. */
#include "rad/beyond/receiver.h"

#include <math.h>

#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/final_gather.h"
#include "rad/beyond/sequence.h"
#include "rad/beyond/sample.h"

/* A leaf is too near for its size if the square of its distance is less than this part of
 * its area. A pixel shows the error at one place, where a receiving leaf has its mean. */
static const double NEAR = 0.2, NEAR_PIXEL = 1.0;

/* A gap is narrow for a leaf if the square of its width is less than this part of the
 * leaf's area. */
static const double NARROW = 0.04;

/* Two surfaces face each other across a gap if the cosine between their normals is
 * less. */
static const double OPPOSITE = -0.7;

/* A lamp is wide if its factor from the leaf, unoccluded, is more than this. */
static const double WIDE = 0.05;

/* A lamp is near if the square of its distance is less than this times its area. */
static const double NEAR_LAMP = 4.0;

/* A point is beside a root if the square of its distance is less than this times the
 * square of the root's radius. */
static const double BESIDE = 2.0;

/* Most points of a path, most tries for a point of a lamp above the horizon, points of a
 * leaf that are tested for being bare. */
enum { PATH_MOST = 8, AIMS_MOST = 4, BARE_POINTS = 4 };

/* Fewest segments that are enough to estimate the visible share of lamps. */
enum { VOLLEY = 4 };

/* Rays in all directions for each that is aimed at a bright root. */
enum { RAYS_PER_AIMED = 4 };

/* --- points that rays meet --- */

struct point {
    int32_t patch;     /* leaf of the forest */
    int32_t input;     /* triangle */
    double weight[3];  /* barycentric coordinates in the leaf, 1 */
    struct vec3 at, normal;
};

/* The leaf of the root at a point of it, and the barycentric coordinates `w` there. */
static int32_t leaf_at(const struct forest *forest, int32_t root, struct vec3 x,
                       double w[3])
{
    struct triangle t = scene_root_triangle(forest->scene, root);
    struct vec3 a = vec3_sub(t.corner[1], t.corner[0]);
    struct vec3 b = vec3_sub(t.corner[2], t.corner[0]), to = vec3_sub(x, t.corner[0]);
    struct vec3 normal = vec3_cross(a, b);
    double unit = 1.0 / vec3_dot(normal, normal);
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

/* Finds the first surface that the ray meets; fills in the point of a front. */
static enum met trace(struct receiver *r, struct vec3 origin, struct vec3 direction,
                  struct point *point)
{
    const struct model *model = r->gather->model;
    const struct scene *scene = model->scene;
    struct octree_hit hit;
    r->gather->counts.rays++;
    if (!octree_first_hit(model->octree, origin, direction, false, &hit,
                          &r->gather->model->counts))
        return MET_NOTHING;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    if (root < 0 || !(scene_root_area(scene, root) > 0.0))
        return MET_BACK;
    struct plane plane = scene_root_plane(scene, root);
    double fall = -vec3_dot(plane.normal, direction); /* above 0: a front is met */
    double along = fall > 0.0 ? plane_distance(&plane, origin) / fall : 0.0;
    point->at = vec3_add(origin, vec3_scale(direction, along));
    point->patch = leaf_at(model->forest, root, point->at, point->weight);
    point->input = hit.triangle;
    point->normal = plane.normal;
    return MET_FRONT;
}

struct vec3 receiver_start(const struct receiver *r, double u, double v)
{
    const struct gather_points *points = r->points;
    return points ? points->at[(int)(u * points->count)]
                  : triangle_of_square(&r->facet.triangle, u, v);
}

/* --- lamps --- */

/* Adds light of lamps that a row's ray has found on a leaf too near. */
static void add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                     double factor)
{
    struct gather_nears *near = &r->gather->near;
    for (int c = 0; c < BANDS && r->near >= 0; c++)
        near->items[r->near].watts[c] += gather_units(
            r->facet.area * weight->band[c] * factor * emission.band[c],
            near->unit_watts);
}

static void add_source(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor)
{
    add_near(r, weight, emission, factor);
    for (int c = 0; c < BANDS; c++) {
        double h = weight->band[c] * factor * emission.band[c];
        r->row.source.band[c] += h;
        r->light.band[c] += h;
    }
}

/* The triangle that blocks a segment to a lamp, or -1. */
static int32_t blocker_of(struct receiver *r, struct vec3 from, int32_t input,
                          struct vec3 to, int32_t lamp)
{
    int32_t own[2] = {input, scene_input_of(r->gather->model->scene, lamp)}, guess = -1;
    r->gather->counts.segments++;
    return octree_blocks_segment(r->gather->model->octree, from, to, own, &guess,
                                 &r->gather->model->counts)
               ? guess
               : -1;
}

int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t lamp)
{
    int32_t input = r->facet.input;
    if (r->points && r->points->above) {
        const struct scene *scene = r->gather->model->scene;
        struct segment segment = segment_make(x, y);
        if (segment_is_blocked_by(&segment, &scene->triangles[input],
                                  &scene->planes[input]))
            return input;
    }
    return blocker_of(r, x, input, y, lamp);
}

/* Segments to groups that are next to each other in the tree, in two halves. */
struct volley {
    double direct[2]; /* light without blockers, over all bands, W/m^2 */
    double seen[2];   /* light with them */
    int count[2];     /* segments */
};

/* The half that segment `i` of `count` to a group belongs to; a single one, the
 * smaller. */
static int half_of(const struct volley *volley, int i, int count)
{
    return count > 1 ? 2 * i >= count : volley->count[0] > volley->count[1];
}

/* Adds the variance of the volley's light, in the colour of one of its lamps: by its
 * visible share as if by chance, and by the difference of its halves. */
static void end_volley(struct receiver *r, struct volley *volley, struct rgb light)
{
    double direct = volley->direct[0] + volley->direct[1];
    int count = volley->count[0] + volley->count[1];
    double seen = volley->seen[0] + volley->seen[1], apart = 0.0;
    double share = count > 0 ? fmin(1.0, seen / direct) : 0.0;
    if (volley->direct[0] > 0.0 && volley->direct[1] > 0.0)
        apart = 0.5 * (volley->seen[0] / volley->direct[0] -
                       volley->seen[1] / volley->direct[1]);
    for (int c = 0; c < BANDS && share > 0.0; c++) {
        double h = direct * light.band[c] / rgb_sum(light);
        r->row.chance[c] += h * h * share * (1.0 - share) / count;
        r->row.halves[c] += h * h * apart * apart;
    }
    *volley = (struct volley){.direct = {0.0, 0.0}};
}

/* The sequence of the segments to a node. */
static struct sequence sequence_to(const struct receiver *r, int32_t node)
{
    return sequence_start(hash_mix(r->seed + 8) ^ hash_mix((uint64_t)node));
}

/* Fires `count` segments at a single lamp: without blockers they bring the irradiance
 * `direct` all together, summed over bands, each in proportion to its kernel. */
static void aim_at_lamp(struct receiver *r, const struct sequence *sequence, int count,
                        int32_t root, double direct, struct volley *volley)
{
    static const struct rgb ALL = {{1.0, 1.0, 1.0}};
    const struct scene *scene = r->gather->model->scene;
    struct triangle lamp = scene_root_triangle(scene, root);
    struct vec3 normal = scene_root_plane(scene, root).normal;
    struct rgb emission = scene_root_material(scene, root)->emission;
    double all[2] = {0.0, 0.0}, seen[2] = {0.0, 0.0}, u[SEQUENCE_DIMENSIONS];
    for (int i = 0; i < count; i++) {
        int half = half_of(volley, i, count);
        sequence_point(sequence, (uint32_t)i, u);
        struct vec3 x = receiver_start(r, u[0], u[1]);
        struct vec3 y = triangle_of_square(&lamp, u[2], u[3]);
        double light = receiver_kernel(x, r->facet.plane.normal, y, normal);
        all[half] += light;
        if (light > 0.0 && receiver_blocker(r, x, y, root) < 0)
            seen[half] += light;
        volley->count[half]++;
    }
    double sum = all[0] + all[1];
    for (int half = 0; half < 2 && sum > 0.0; half++) {
        volley->direct[half] += direct * (all[half] / sum);
        volley->seen[half] += direct * (seen[half] / sum);
    }
    if (sum > 0.0)
        add_source(r, &ALL, emission,
                   direct * ((seen[0] + seen[1]) / sum) / rgb_sum(emission));
}

/* The same for a wide lamp, whose variance is known. */
static void aim_at_wide_lamp(struct receiver *r, int count, int32_t root, double direct)
{
    static const struct rgb ALL = {{1.0, 1.0, 1.0}};
    struct sequence sequence = sequence_to(r, root);
    struct rgb emission = scene_root_material(r->gather->model->scene, root)->emission;
    struct receiver_share share = receiver_share_of_wide(r, &sequence, count, root);
    add_source(r, &ALL, emission, direct * share.seen / rgb_sum(emission));
    for (int c = 0; c < BANDS; c++) {
        double h = direct * emission.band[c] / rgb_sum(emission);
        r->row.chance[c] += h * h * share.variance;
        r->row.halves[c] += h * h * share.halves;
    }
}

/* Adds the mesh's light at a point; `aimed`: without emission. */
static void add_mesh(struct receiver *r, const struct point *point, bool aimed,
                     const struct rgb *weight)
{
    const struct forest *forest = r->gather->model->forest;
    receiver_add_point(r, point->patch, point->weight, weight);
    if (aimed)
        add_source(r, weight, forest_material(forest, point->patch)->emission, -1.0);
}

static bool is_beside(const struct scene *scene, int32_t root, struct vec3 x)
{
    struct triangle t = scene_root_triangle(scene, root);
    struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
    double radius = triangle_radius(&t);
    return vec3_dot(apart, apart) < BESIDE * radius * radius;
}

static int32_t root_of(const struct receiver *r, const struct point *point)
{
    return (int32_t)r->gather->model->forest->patches[point->patch].id.root;
}

/* Adds the light of a bright root that has this form factor, where a ray that is aimed at
 * y meets it. */
static void aim_at_bright(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root,
                          double factor)
{
    const struct final_gather *g = r->gather;
    struct vec3 way = vec3_sub(y, x);
    struct point point;
    if (is_beside(g->model->scene, root, x) ||
        trace(r, point_above(x, r->facet.plane.normal),
              vec3_scale(way, 1.0 / vec3_length(way)), &point) != MET_FRONT ||
        root_of(r, &point) != root)
        return;
    add_mesh(r, &point, root_is_lamp(&g->lamps, root),
             &(struct rgb){{factor, factor, factor}});
    r->bright += factor;
}

/* Fires one segment, or aimed ray, at a lamp of a group: it stands for `each` of the
 * group's light. */
static void aim_at_some(struct receiver *r, const struct lamps *lamps,
                        const struct sequence *sequence, uint32_t index,
                        const struct lamp_group *group, double each)
{
    static const struct rgb ALL = {{1.0, 1.0, 1.0}};
    const struct scene *scene = r->gather->model->scene;
    double u[SEQUENCE_DIMENSIONS];
    sequence_point(sequence, index, u);
    struct lamp lamp = lamp_choose(lamps, group->node, hash_unit(r->seed + 17 + index));
    struct triangle triangle = scene_root_triangle(scene, lamp.root);
    struct vec3 x = receiver_start(r, u[0], u[1]);
    struct vec3 y = triangle_of_square(&triangle, u[2], u[3]);
    double factor = receiver_kernel(x, r->facet.plane.normal, y,
                                    scene_root_plane(scene, lamp.root).normal) *
                    scene_root_area(scene, lamp.root) * lamp.share *
                    (each / group->direct);
    if (!(factor > 0.0))
        return;
    if (lamps->reflect)
        aim_at_bright(r, x, y, lamp.root, factor);
    else if (receiver_blocker(r, x, y, lamp.root) < 0)
        add_source(r, &ALL, lamp_light(lamps, lamp.root), factor);
}

/* Fires `count` of them at a group; unoccluded they bring `direct` all together. */
static void aim_at_group(struct receiver *r, const struct lamps *lamps,
                         const struct lamp_group *group, int count, double direct,
                         struct volley *volley)
{
    struct sequence sequence = sequence_to(r, group->node);
    bool single = !node_is_cluster(group->node) && !lamps->reflect;
    if (single)
        aim_at_lamp(r, &sequence, count, group->node, direct, volley);
    for (int k = 0; k < count && !single; k++) {
        int half = half_of(volley, k, count);
        double before = rgb_sum(r->light);
        aim_at_some(r, lamps, &sequence, (uint32_t)k, group, direct / count);
        volley->direct[half] += direct / count;
        volley->seen[half] += rgb_sum(r->light) - before;
        volley->count[half]++;
    }
}

static bool is_wide(const struct lamps *lamps, const struct lamp_group *group)
{
    return !lamps->reflect && !node_is_cluster(group->node) &&
           group->direct > WIDE * lamps->sent[group->node];
}

/* Adds the light of lamps by as many segments as rays, or of bright roots by fewer rays,
 * dealt to the groups in proportion to their light. A group that is sure to get a segment
 * counts with its own light, shared among its segments, for their number depends on where
 * dealing starts. */
static void aim_at_lamps(struct receiver *r, struct lamps *lamps)
{
    lamps_group(lamps, &r->facet, &r->gather->model->estimating);
    if (!(lamps->groups.direct > 0.0))
        return;
    int most = lamps->reflect ? (r->rays + RAYS_PER_AIMED - 1) / RAYS_PER_AIMED : r->rays;
    double each = lamps->groups.direct / most, sum = 0.0;
    double start = hash_unit(r->seed + 16);
    struct volley volley = {.direct = {0.0, 0.0}};
    struct rgb light = {{0.0, 0.0, 0.0}};
    int done = 0;
    for (int64_t i = 0; i < lamps->groups.count; i++) {
        const struct lamp_group *group = &lamps->groups.items[i];
        sum += group->direct;
        int now = (int)fmin(most, floor(sum / each + start)), count = now - done;
        if (count == 0)
            continue;
        double direct = group->direct >= each ? group->direct : count * each;
        done = now;
        if (is_wide(lamps, group)) {
            aim_at_wide_lamp(r, count, group->node, direct);
            continue;
        }
        aim_at_group(r, lamps, group, count, direct, &volley);
        light = lamp_light(lamps, lamp_choose(lamps, group->node, 0.5).root);
        if (volley.count[0] + volley.count[1] >= VOLLEY)
            end_volley(r, &volley, light);
    }
    end_volley(r, &volley, light);
}

/* --- paths --- */

/* True if a lamp is so near, for its size, that rays from a point find it often enough:
 * on the way of a path they count its emission, and segments do not. */
static bool lamp_is_near(const struct scene *scene, int32_t lamp, struct vec3 x)
{
    struct triangle t = scene_root_triangle(scene, lamp);
    struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
    return vec3_dot(apart, apart) < NEAR_LAMP * scene_root_area(scene, lamp);
}

/* The light of one lamp at a point beside the leaf; the lamp and a point of it are chosen
 * by hashes. Of a lamp that the horizon cuts, a point above it. */
static void aim_beside(struct receiver *r, const struct point *x,
                       const struct rgb *weight,
                       uint64_t seed)
{
    const struct final_gather *g = r->gather;
    const struct scene *scene = g->model->scene;
    double at = hash_unit(seed) * g->lamps.groups.around;
    int64_t i = 0;
    for (; i < g->lamps.groups.count - 1 && at >= g->lamps.groups.items[i].around; i++)
        at -= g->lamps.groups.items[i].around;
    if (!(g->lamps.groups.around > 0.0) || !(g->lamps.groups.items[i].around > 0.0))
        return;
    const struct lamp_group *group = &g->lamps.groups.items[i];
    struct lamp lamp = lamp_choose(&g->lamps, group->node, hash_unit(seed + 1));
    if (lamp_is_near(scene, lamp.root, x->at))
        return;
    struct triangle triangle = scene_root_triangle(scene, lamp.root);
    struct vec3 normal = scene_root_plane(scene, lamp.root).normal;
    double factor = point_triangle_factor(x->at, x->normal, &triangle);
    for (uint64_t k = 0; k < AIMS_MOST && factor > 0.0; k++) {
        struct vec3 y = triangle_of_square(&triangle, hash_unit(seed + 2 + 2 * k),
                                       hash_unit(seed + 3 + 2 * k));
        if (!(receiver_kernel(x->at, x->normal, y, normal) > 0.0))
            continue;
        if (blocker_of(r, x->at, x->input, y, lamp.root) < 0)
            add_source(r, weight, scene_root_material(scene, lamp.root)->emission,
                       factor * lamp.share * (g->lamps.groups.around / group->around));
        return;
    }
}

/* True if the leaf that a ray has met is too near to the ray's origin, for its size, for
 * its mean radiosity to hold there. The distance is that of its centroid, so that a point
 * takes the mean of the whole leaf or none of it: a far part alone would be given the
 * mean of the whole. In a gap that is narrow for the leaf all of it is too near, for it
 * may reach from the gap into the light. */
static bool is_too_near(const struct receiver *r, const struct point *met, struct vec3 x,
                        struct vec3 normal)
{
    const struct forest *forest = r->gather->model->forest;
    double near = r->points ? NEAR_PIXEL : NEAR;
    struct triangle t = forest_triangle(forest, met->patch);
    struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
    double area = forest_area(forest, met->patch), width = vec3_dot(apart, met->normal);
    return vec3_dot(apart, apart) < near * area ||
           (width * width < NARROW * area && vec3_dot(normal, met->normal) < OPPOSITE);
}

static bool is_covered(const struct final_gather *gather, int32_t leaf)
{
    return gather->near.covered && gather->near.covered[gather->place[leaf]];
}

/* A ray has met a back. Where the floor is covered by a thing that stands on it, a point
 * is inside of that thing, and another ray from there meets a back, too. */
static void look_inside(struct receiver *r, struct vec3 origin, struct vec3 direction)
{
    struct vec3 normal = r->facet.plane.normal;
    struct vec3 up = vec3_scale(normal, 2.0 * vec3_dot(normal, direction));
    struct point point;
    if (trace(r, origin, vec3_sub(up, direction), &point) == MET_BACK)
        r->inside++;
    else
        r->escaped++;
}

/* Russian roulette: the path goes on, for all that would have, with the probability of
 * the largest reflectance. The mesh's light is added in the mean whether it goes on or
 * not, so that rows still sum to 1. */
static bool goes_on(struct receiver *r, const struct point *point, bool aimed, double u,
                    struct rgb *weight)
{
    const struct rgb *rho =
        &forest_material(r->gather->model->forest, point->patch)->reflectance;
    double most = fmax(rho->band[0], fmax(rho->band[1], rho->band[2]));
    struct rgb rest = *weight;
    if (u < most) {
        for (int c = 0; c < BANDS; c++) {
            weight->band[c] /= most;
            rest.band[c] -= weight->band[c];
        }
    }
    add_mesh(r, point, aimed, &rest);
    return u < most;
}

/* A row's ray begins a path: the leaf that it has met is too near. */
static void begin_path(struct receiver *r, const struct point *met, bool aimed,
                       const struct rgb *weight)
{
    struct final_gather *g = r->gather;
    if (!r->keeps) /* a look's leaves may have no places yet */
        return;
    r->near = g->place[met->patch];
    g->near.items[r->near].area +=
        gather_units(r->facet.area / r->rays, g->near.unit_area);
    if (aimed) /* segments bring it, so the path does not count it */
        add_near(r, weight, forest_material(g->model->forest, met->patch)->emission, 1.0);
}

/* Follows a path from its first ray on, and adds its light, times `weight`. The ray is of
 * this half. */
static void follow(struct receiver *r, struct vec3 origin, struct vec3 direction,
                   struct rgb weight, int half, uint64_t seed)
{
    const struct forest *forest = r->gather->model->forest;
    struct vec3 normal = r->facet.plane.normal; /* at the origin */
    for (int count = 1;; count++, seed += 16) {
        struct point point;
        enum met met = trace(r, origin, direction, &point);
        if (met == MET_BACK && count == 1)
            look_inside(r, origin, direction);
        else
            r->escaped += met != MET_FRONT;
        if (met != MET_FRONT)
            return;
        const struct material *material = forest_material(forest, point.patch);
        int32_t root = root_of(r, &point);
        const struct scene *scene = r->gather->model->scene;
        if (count == 1 && root_is_lamp(&r->gather->bright, root) &&
            !is_beside(scene, root, origin)) {
            r->sums.aside[half]++;
            return;
        }
        bool aimed = root_is_lamp(&r->gather->lamps, root) &&
                     (count == 1 || !lamp_is_near(scene, root, origin));
        if (count == PATH_MOST || !(is_too_near(r, &point, origin, normal) ||
                                    is_covered(r->gather, point.patch))) {
            add_mesh(r, &point, aimed, &weight);
            return;
        }
        if (count == 1)
            begin_path(r, &point, aimed, &weight);
        if (count > 1 && !goes_on(r, &point, aimed, hash_unit(seed + 13), &weight))
            return;
        if (!aimed)
            add_source(r, &weight, material->emission, 1.0);
        for (int c = 0; c < BANDS; c++)
            weight.band[c] *= material->reflectance.band[c];
        if (!(rgb_sum(weight) > 0.0))
            return;
        aim_beside(r, &point, &weight, seed);
        normal = point.normal;
        origin = point_above(point.at, normal);
        direction = cosine_direction(normal, direction_along(normal),
                                     hash_unit(seed + 14), hash_unit(seed + 15));
    }
}

/* Adds the light of ray i's path to the sums, and to the half of the rays that it belongs
 * to. */
static void count_light(struct receiver *r, int i, int half)
{
    for (int c = 0; c < BANDS; c++) {
        double h = r->light.band[c];
        r->sums.h.band[c] += h;
        r->sums.squares.band[c] += h * h;
        r->sums.half[half].band[c] += h;
        if (r->sums.each)
            r->sums.each[i].band[c] += h;
        r->light.band[c] = 0.0;
    }
}

/* Adds the variance by rays other than those that have met bright roots. */
static void add_variances(struct receiver *r)
{
    double count[2] = {(r->rays + 1) / 2 - r->sums.aside[0],
                       r->rays / 2 - r->sums.aside[1]};
    double all = count[0] + count[1];
    for (int c = 0; c < BANDS && all > 0.0; c++) {
        double mean2 = r->sums.h.band[c] * r->sums.h.band[c] / all, apart = 0.0;
        if (count[0] > 0.0 && count[1] > 0.0)
            apart = 0.5 * all * (r->sums.half[0].band[c] / count[0] -
                                 r->sums.half[1].band[c] / count[1]);
        r->row.chance[c] += fmax(0.0, r->sums.squares.band[c] - mean2);
        r->row.halves[c] += apart * apart;
    }
}

/* Aims at the bright roots, and makes the light of rays, which have not counted them,
 * that of all other directions, so that the row still sums to 1. `source`: of the row
 * before rays were fired. */
static void add_bright(struct receiver *r, struct rgb source)
{
    struct gather_sums *sums = &r->gather->sums;
    struct rgb after = r->row.source;
    int aside = r->sums.aside[0] + r->sums.aside[1];
    sums->first = sums->count;
    aim_at_lamps(r, &r->gather->bright);
    double other = fmax(0.0, 1.0 - r->bright) * r->rays;
    other /= aside < r->rays ? r->rays - aside : r->rays;
    for (int64_t i = 0; i < sums->first; i++)
        for (int c = 0; c < BANDS; c++)
            sums->items[i].weight[c] *= other;
    for (int c = 0; c < BANDS; c++) {
        r->row.source.band[c] += (other - 1.0) * (after.band[c] - source.band[c]);
        r->sums.h.band[c] = other * r->sums.h.band[c] + r->light.band[c];
        r->light.band[c] = 0.0;
    }
}

void receiver_fire(struct receiver *r)
{
    struct sequence sequence = sequence_start(r->seed);
    struct rgb source = r->row.source;
    double share = 1.0 / r->rays, u[SEQUENCE_DIMENSIONS];
    for (int i = 0; i < r->rays; i++) {
        int half = 2 * i / r->rays;
        sequence_point(&sequence, (uint32_t)i, u);
        struct vec3 x = receiver_start(r, u[2], u[3]);
        follow(r, point_above(x, r->facet.plane.normal),
               cosine_direction(r->facet.plane.normal, r->along, u[0], u[1]),
               (struct rgb){{share, share, share}}, half,
               hash_mix(r->seed ^ hash_mix((uint64_t)i)));
        r->near = -1;
        count_light(r, i, half);
    }
    add_variances(r);
    add_bright(r, source);
    if (r->escaped < r->rays)
        r->gather->counts.escaped += r->escaped;
}

float receiver_bare_share(const struct receiver *r)
{
    static const double ABOVE = 0x1p-26; /* scene units */
    struct model *model = r->gather->model;
    struct sequence sequence = sequence_start(r->seed + 24);
    struct vec3 normal = r->facet.plane.normal;
    double u[SEQUENCE_DIMENSIONS];
    int covered = 0;
    if (r->gather->sums.count == 0 && !(rgb_sum(r->row.source) > 0.0))
        return 0.0f;
    for (uint32_t i = 0; i < BARE_POINTS; i++) {
        sequence_point(&sequence, i, u);
        struct vec3 x = triangle_of_square(&r->facet.triangle, u[0], u[1]);
        struct octree_hit hit;
        covered +=
            octree_first_hit(model->octree, vec3_add(x, vec3_scale(normal, ABOVE)),
                             vec3_scale(normal, -1.0), false, &hit, &model->counts) &&
            hit.triangle != r->facet.input;
    }
    return (1.0f - (float)covered / BARE_POINTS) *
           (1.0f - (float)r->inside / (float)r->rays);
}

/* --- public --- */

double receiver_kernel(struct vec3 x, struct vec3 normal_x, struct vec3 y,
                       struct vec3 normal_y)
{
    struct vec3 d = vec3_sub(y, x);
    double d2 = vec3_dot(d, d);
    double rise = vec3_dot(normal_x, d), fall = -vec3_dot(normal_y, d);
    return rise > 0.0 && fall > 0.0 ? rise * fall / (PI * d2 * d2) : 0.0;
}

void receiver_aim(struct receiver *r)
{
    aim_at_lamps(r, &r->gather->lamps);
    r->lamps = r->light;
    r->light = (struct rgb){{0.0, 0.0, 0.0}};
}
