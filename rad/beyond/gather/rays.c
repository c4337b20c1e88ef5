/* Rays of the final gather.
 *
 * Rays leave a receiver from points spread over it, distributed as the cosine, and each
 * that ends on a front adds 1 / N to the weight of the leaf that it meets. So in a closed
 * scene each row sums to 1, by construction and not by luck. Noise is their only fault,
 * and lamps are where most of it would come from: these are aimed at (gather_aim.c), and
 * rays that meet a lamp count its reflected light and not its emission. Bright patches
 * are aimed at, too: a ray that was not, and meets one, is put aside, and the others
 * stand for all directions but those of bright patches,
 *
 *     H = sum over aimed rays of F B  +  (1 - sum of F) * mean of B over the others,
 *
 * so rows still sum to 1. In a row, rays that have met lamps stand for the form factor of
 * these, if segments leave little doubt of it. Beside a bright patch all this does not
 * apply: rays find it often enough, and factors of a few points of it would vary without
 * bound.
 *
 * The mesh is wrong where a ray ends nearer than the leaf there is large: under a sheet
 * of paper on a table the table is dark, but the leaf is not. And it is wrong in a gap
 * that is narrow for the leaf, up to some widths of the leaf from where the ray began:
 * the leaf may reach into the light. It is wrong, too, where something cuts the leaf, as
 * a wall does that stands on it, and where a box stands on part of it: pictures know such
 * leaves. There the ray goes on: the point that it met receives light from a lamp, by one
 * segment, and from one more ray, until a ray ends far enough away. That is a path tracer
 * for near surfaces and radiosity for the rest. In pixels one ray is aimed at a bright
 * patch from there, too: else single pixels shine along all edges of a room. */
#include "rad/beyond/gather/met.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/gather/gather.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* A leaf is too near if the square of the length of the ray that has met it is less than
 * this times the leaf's area. */
static const double NEAR = 0.1;

/* A point is beside a patch if the square of its distance is less than this times the
 * square of the patch's radius. */
static const double BESIDE = 2.0;

/* Most points of a path; those from which it goes on in any case. */
enum { PATH_MOST = 256, PATH_SURE = 2 };

/* --- the mesh --- */

/* Adds the mesh's light at a point; `aimed`: without emission. */
static inline void add_mesh(struct receiver *r, const struct point *point, bool aimed,
                            const struct rgb *weight)
{
    const struct forest *forest = r->gather->model->forest;
    struct rgb emission = forest_material(forest, point->patch)->emission;
    receiver_add_point(r, point->patch, point->weight, weight);
    if (aimed)
        receiver_add_source(r, weight, emission, -1.0);
}

static bool is_beside(const struct forest *forest, int32_t patch, struct vec3 x)
{
    struct triangle t = forest_triangle(forest, patch);
    struct vec3 apart = vec3_sub(triangle_centroid(&t), x);
    double radius = triangle_radius(&t);
    return vec3_dot(apart, apart) < BESIDE * radius * radius;
}

static int32_t root_of(const struct receiver *r, const struct point *point)
{
    return (int32_t)r->gather->model->forest->patches[point->patch].id.root;
}

/* True if the point that a path has met is of a lamp, which is aimed at from x on its
 * way. */
static bool is_aimed_lamp(const struct receiver *r, const struct point *met,
                          struct vec3 x)
{
    int32_t root = root_of(r, met);
    return root_is_sender(r->gather->lamps, root) &&
           !receiver_lamp_is_near(r->gather->model->scene, root, x);
}

/* True if a ray from x takes the mesh's light at the point that it has met. The leaf there
 * is too near for its mean to hold if less than a third of it is within the ray's length
 * of the point: what stands that near, the receiver itself above all, shades or lights
 * this part of the leaf and not the rest. (pi .1 = 1/3.) */
static bool ends_on_mesh(const struct receiver *r, const struct point *met, struct vec3 x)
{
    struct vec3 ray = vec3_sub(met->at, x);
    return vec3_dot(ray, ray) >= NEAR * r->gather->near.leaves[met->patch].area;
}

/* A ray has met a back, and not from inside of a thing: else another ray from there meets
 * a back, too. */
static void look_again(struct receiver *r, struct vec3 origin, struct vec3 direction)
{
    struct vec3 normal = r->facet.plane.normal;
    struct vec3 up = vec3_scale(normal, 2.0 * vec3_dot(normal, direction));
    struct point point;
    if (probe(r, origin, vec3_sub(up, direction), &point) != MET_BACK)
        r->escaped++;
}

/* Russian roulette: the path goes on, for all that would have, with the probability of
 * the largest reflectance. The mesh's light is added in the mean whether it goes on or
 * not, so that rows still sum to 1. That is noise where the mesh is far from right, as in
 * the shade at the edge of a wide bright leaf, so few paths get here. Deep in a gap
 * between bright surfaces paths are long: if they ended soon with the mesh's light, which
 * is the mean of inside and outside, gaps would shine. Rejected: ending half of the
 * longest and giving their light to the others; what is then taken off the mesh makes
 * large rows of both signs, by which light at rho .999 is not found. */
static bool survives(struct receiver *r, const struct point *point, bool aimed, double u,
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

/* A path that has met the point goes on from there: adds the emission, unless it is
 * `aimed` at, and the light of a lamp, and makes a ray of the seed's. False if the point
 * absorbs all. */
static bool leave(struct receiver *r, const struct point *point, bool aimed,
                  uint64_t seed, struct rgb *weight, struct vec3 *origin,
                  struct vec3 *direction)
{
    const struct material *material =
        forest_material(r->gather->model->forest, point->patch);
    if (!aimed)
        receiver_add_source(r, weight, material->emission, 1.0);
    for (int c = 0; c < BANDS; c++)
        weight->band[c] *= material->reflectance.band[c];
    if (!(rgb_sum(*weight) > 0.0))
        return false;
    receiver_aim_beside(r, point->at, point->normal, point->patch, weight, seed);
    *origin = point_above(point->at, point->normal);
    *direction = cosine_direction(point->normal, direction_along(point->normal),
                                  hash_unit(seed + 14), hash_unit(seed + 15));
    return true;
}

/* True if rays from x are aimed at the bright patch that the point which one has met is
 * on. From pixels the path of such a ray goes on where it does not end
 * on the mesh, from the holder of a bulb, say: found by chance it is a bright speck. */
static bool is_aimed_at(const struct receiver *r, const struct point *met, struct vec3 x)
{
    int32_t bright = r->gather->bright->part_of[met->patch];
    return bright >= 0 && !is_beside(r->gather->model->forest, bright, x) &&
           (r->points || ends_on_mesh(r, met, x));
}

/* True if the bright patch that a path has met, from x on its way, is aimed at from
 * there: in pixels, if a point of all bright patches, chosen by power, brings no more
 * light than a ray that meets this one. (A row would no longer sum to 1.) */
static bool is_aimed_at_beside(const struct receiver *r, const struct point *met,
                               struct vec3 x)
{
    const struct senders *bright = r->gather->bright;
    int32_t patch = bright->part_of[met->patch];
    if (!r->points || patch < 0)
        return false;
    struct vec3 ray = vec3_sub(met->at, x);
    double sent = rgb_sum(sender_light(bright, patch));
    return PI * vec3_dot(ray, ray) * sent >= senders_power(bright);
}

/* A path goes on from a point that it has met and does not end on; adds its light, times
 * `weight`. `aims`: from all of its points at bright patches. */
static void go_on(struct receiver *r, struct point point, bool aimed, struct rgb weight,
                  uint64_t seed, bool aims);

/* Adds `weight` times the light of such patches, by one ray from x. */
static void look_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                        const struct rgb *weight, uint64_t seed)
{
    const struct final_gather *g = r->gather;
    if (!r->points || !(senders_power(g->bright) > 0.0))
        return;
    struct choice bright = sender_choose(g->bright, g->bright->nodes, hash_unit(seed));
    struct facet facet = facet_make(g->model->forest, bright.patch);
    struct vec3 y =
        triangle_of_square(&facet.triangle, hash_unit(seed + 1), hash_unit(seed + 2));
    double factor =
        bright.share * facet.area * point_kernel(x, normal, y, facet.plane.normal);
    struct point point;
    if (!(factor > 0.0) ||
        trace(r, x, vec3_unit(vec3_sub(y, x)), &point) != MET_FRONT ||
        g->bright->part_of[point.patch] != bright.patch || !is_aimed_at_beside(r, &point, x))
        return;
    struct rgb light = *weight;
    for (int c = 0; c < BANDS; c++)
        light.band[c] *= factor;
    bool aimed = is_aimed_lamp(r, &point, x);
    if (ends_on_mesh(r, &point, x))
        add_mesh(r, &point, aimed, &light);
    else
        go_on(r, point, aimed, light, hash_mix(seed), false);
}

void receiver_see(struct receiver *r, struct vec3 x, struct vec3 y, int32_t patch,
                  double factor, uint64_t seed)
{
    const struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    int32_t root = (int32_t)forest->patches[patch].id.root;
    struct point point = {.at = y,
                          .normal = scene_root_plane(forest->scene, root).normal};
    find_leaf(forest, root, &point);
    if (!is_aimed_at(r, &point, x))
        return;
    struct rgb weight = {{factor, factor, factor}};
    bool aimed = root_is_sender(g->lamps, root);
    r->shares.bright += factor;
    if (ends_on_mesh(r, &point, x))
        add_mesh(r, &point, aimed, &weight);
    else
        go_on(r, point, aimed, weight, seed, true);
}

/* A row's ray begins a path: the leaf that it has met is too near. */
static void begin_path(struct receiver *r, const struct point *met, bool aimed,
                       const struct rgb *weight)
{
    struct final_gather *g = r->gather;
    struct rgb emission = forest_material(g->model->forest, met->patch)->emission;
    struct gather_nears *near = &g->near;
    if (!r->keeps) /* a look's leaves may have no places yet */
        return;
    r->near = g->place[met->patch];
    RESERVE(near->paths, &near->path_capacity, near->path_count + 1);
    near->paths[near->path_count++] = (struct gather_path){.place = r->near};
    if (aimed) /* segments bring it, so the path does not count it */
        receiver_add_near(r, weight, emission, 1.0);
}

static void go_on(struct receiver *r, struct point point, bool aimed, struct rgb weight,
                  uint64_t seed, bool aims)
{
    for (int count = 1; count < PATH_MOST; count++, seed += 16) {
        struct vec3 origin, direction, normal = point.normal;
        if (count > PATH_SURE &&
            !survives(r, &point, aimed, hash_unit(seed + 13), &weight))
            return;
        if (!leave(r, &point, aimed, seed, &weight, &origin, &direction))
            return;
        if (aims)
            look_beside(r, origin, normal, &weight, seed + 10);
        if (trace(r, origin, direction, &point) != MET_FRONT) {
            r->escaped++;
            return;
        }
        aimed = is_aimed_lamp(r, &point, origin);
        if (aims && is_aimed_at_beside(r, &point, origin))
            return;
        if (count + 1 == PATH_MOST || ends_on_mesh(r, &point, origin)) {
            add_mesh(r, &point, aimed, &weight);
            return;
        }
    }
}

/* Follows a path from a ray of the stream on, and adds its light, times `weight`. The ray
 * is of this half. */
static void follow(struct receiver *r, const struct stream *stream, int ray,
                   struct rgb weight, int half, uint64_t seed)
{
    struct vec3 origin = stream->origins[ray], direction = stream->directions[ray];
    const struct forest *forest = r->gather->model->forest;
    struct point point;
    enum met met = meet(r, origin, direction, &stream->hits[ray], &point);
    if (ray_comes_from_inside(r, origin, direction)) {
        r->sums.inside++;
        return;
    }
    if (met == MET_BACK)
        look_again(r, origin, direction);
    else
        r->escaped += met != MET_FRONT;
    if (met != MET_FRONT)
        return;
    find_leaf(forest, point.patch, &point);
    if (is_aimed_at(r, &point, origin)) {
        r->sums.aside[half]++;
        return;
    }
    bool aimed = root_is_sender(r->gather->lamps, root_of(r, &point));
    if (ends_on_mesh(r, &point, origin)) {
        add_mesh(r, &point, aimed, &weight);
    } else {
        begin_path(r, &point, aimed, &weight);
        go_on(r, point, aimed, weight, seed, true);
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

/* Adds the variance by rays other than those that have met bright patches. */
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

/* The factor of the weights of rays that are not put aside: they stand for all directions
 * but those that are aimed at. */
static double factor_of_rays(const struct receiver *r)
{
    int aside = r->sums.aside[0] + r->sums.aside[1];
    double rest = fmax(0.0, 1.0 - r->shares.bright) * r->rays;
    return rest / (aside < r->rays ? r->rays - aside : r->rays);
}

/* Adds the light of the row's paths to that of the leaves too near that they have
 * met first. `factor`: of their weights, and so of the area: else leaves would be seen
 * too bright from afar. */
static void add_paths(struct gather_nears *near, const struct receiver *r, double factor)
{
    double area = factor * r->facet.area;
    for (int64_t i = 0; i < near->path_count; i++) {
        const struct gather_path *path = &near->paths[i];
        struct gather_near *item = &near->items[path->place];
        int64_t units = gather_units(area / r->rays, near->unit_area);
        item->area += units > 0 ? units : 1; /* so that the leaf gets a number */
        for (int c = 0; c < BANDS; c++)
            item->watts[c] += gather_units(area * path->light.band[c], near->unit_watts);
    }
    near->path_count = 0;
}

/* Aims at the bright patches, and makes the light of rays, which have not counted them,
 * that of all other directions, so that the row still sums to 1. `source`: of the row
 * before rays were fired. */
static void add_bright(struct receiver *r, struct rgb source)
{
    struct final_gather *g = r->gather;
    struct gather_sums *sums = &g->sums;
    struct rgb after = r->row.source;
    sums->first = sums->count;
    receiver_aim_at_bright(r);
    double factor = factor_of_rays(r);
    add_paths(&g->near, r, factor);
    for (int64_t i = 0; i < sums->first; i++)
        for (int c = 0; c < BANDS; c++)
            sums->items[i].weight[c] *= factor;
    for (int c = 0; c < BANDS; c++) {
        r->row.source.band[c] += (factor - 1.0) * (after.band[c] - source.band[c]);
        r->sums.h.band[c] = factor * r->sums.h.band[c] + r->light.band[c];
        r->light.band[c] = 0.0;
    }
}

/* True if a ray of the stream has met a back: a thing may stand on the leaf. */
static bool meets_backs(const struct receiver *r, const struct stream *stream)
{
    const struct scene *scene = r->gather->model->scene;
    for (int i = 0; i < stream->count; i++) {
        const struct octree_hit *hit = &stream->hits[i];
        if (!hit->front && hit->triangle >= 0 && !scene_has_twin(scene, hit->triangle))
            return true;
    }
    return false;
}

/* Finds what the next rays of the receiver meet, as many as a stream takes. */
static void fill_stream(struct receiver *r, const struct sequence *sequence, int first,
                        struct stream *stream)
{
    struct model *model = r->gather->model;
    struct vec3 normal = r->facet.plane.normal;
    double u[SEQUENCE_DIMENSIONS];
    stream->count = r->rays - first < STREAM_RAYS ? r->rays - first : STREAM_RAYS;
    for (int i = 0; i < stream->count; i++) {
        sequence_point(sequence, (uint32_t)(first + i), u);
        stream->origins[i] = point_above(receiver_start(r, u[2], u[3]), normal);
        stream->directions[i] = cosine_direction(normal, r->along, u[0], u[1]);
    }
    octree_stream_hits(model->octree, stream, false, &model->counts);
    r->sums.on_back = r->keeps && (r->sums.on_back || meets_backs(r, stream));
}

void receiver_fire(struct receiver *r)
{
    struct sequence sequence = sequence_start(r->seed);
    struct rgb source = r->row.source;
    struct stream stream;
    double share = 1.0 / r->rays;
    for (int i = 0; i < r->rays; i++) {
        int half = 2 * i / r->rays, k = i % STREAM_RAYS;
        if (k == 0)
            fill_stream(r, &sequence, i, &stream);
        follow(r, &stream, k, (struct rgb){{share, share, share}}, half,
               hash_mix(r->seed ^ hash_mix((uint64_t)i)));
        r->near = -1;
        count_light(r, i, half);
    }
    receiver_find_outside(r);
    if (r->sums.inside == r->rays)
        return; /* what could be aimed at would be walls that things touch */
    add_variances(r);
    add_bright(r, source);
    if (r->escaped < r->rays)
        r->gather->counts.escaped += r->escaped;
}
