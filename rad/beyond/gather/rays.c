/* Rays of the final gather.
 *
 * N rays leave a receiver from points spread over it, distributed as the cosine, and each
 * ending on a front adds 1 / N to the weight of the leaf met. So in a closed scene each
 * row sums to 1, by construction and not by luck. Noise is the only fault, and most would
 * come from lamps: these are aimed at (aim.c), and rays meeting a lamp count its
 * reflected light and not its emission. Bright patches are aimed at, too: a ray meeting
 * one by chance is put aside, and the others stand for all other directions,
 *
 *     H = sum over aimed rays of F B  +  (1 - sum of F) * mean of B over the others,
 *
 * so rows still sum to 1. Beside a bright patch all this does not apply: rays find the
 * patch often enough, and factors of a few of its points would vary without bound.
 *
 * A ray ending too near goes on as a path (path.c). */
#include "rad/beyond/gather/rays.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/gather/aim.h"
#include "rad/beyond/gather/covers.h"
#include "rad/beyond/gather/pane.h"
#include "rad/beyond/gather/path.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* A ray has met a back, and counts as escaped; but not if a second one from its point,
 * mirrored at the normal, meets a back, too: then the point is inside. */
static void look_again(struct receiver *r, struct vec3 origin, struct vec3 direction)
{
    struct vec3 normal = r->facet.plane.normal;
    struct vec3 up = vec3_scale(normal, 2.0 * vec3_dot(normal, direction));
    struct point point;
    if (probe(r, origin, vec3_sub(up, direction), &point) != MET_BACK)
        r->escaped++;
}

/* A row's ray begins a path: the leaf met is too near. */
static void begin_path(struct receiver *r, const struct point *met, bool aimed,
                       const struct rgb *weight)
{
    struct final_gather *g = r->gather;
    struct rgb emission = forest_material(g->model->forest, met->patch)->emission;
    struct gather_nears *near = g->near;
    if (r->kind != RECEIVER_ROW) /* a look's leaves may have no places yet */
        return;
    r->near = g->place[met->patch];
    RESERVE(near->paths, &near->path_capacity, near->path_count + 1);
    near->paths[near->path_count++] = (struct gather_path){.place = r->near};
    if (aimed) /* segments bring the emission, which the path does not count */
        receiver_add_near(r, weight, emission, 1.0);
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
    if (r->sums->on_back && ray_comes_from_inside(r, origin, direction)) {
        r->sums->inside++;
        return;
    }
    if (met == MET_BACK)
        look_again(r, origin, direction);
    else
        r->escaped += met != MET_FRONT;
    struct pane_walk walk = receiver_walk(r, origin, direction, met, &point);
    if (receiver_puts_aside(r, walk, -1)) {
        r->sums->aside[half]++;
        return;
    }
    if (met != MET_FRONT) {
        receiver_cross(r, walk, &weight);
        return;
    }
    r->sums->in_gap += r->kind == RECEIVER_ROW && ray_ends_in_gap(r, origin, point.at);
    find_leaf(forest, &point);
    if (path_is_aimed_at(r, &point, origin)) {
        r->sums->aside[half]++;
        return;
    }
    receiver_cross(r, walk, &weight);
    bool aimed = root_is_lamp(r->gather, point.root);
    if (path_ends(r, &point, origin)) { /* as most do */
        path_add_mesh(r, &point, aimed, &weight);
        return;
    }
    begin_path(r, &point, aimed, &weight);
    path_go_on(r, point, origin, aimed, weight, seed, true);
}

/* Adds the light of ray i's path to the sums, and to its half of the rays. */
static void count_light(struct receiver *r, int i, int half)
{
    for (int c = 0; c < BANDS; c++) {
        double h = r->light.band[c];
        r->sums->h.band[c] += h;
        r->sums->squares.band[c] += h * h;
        r->sums->half[half].band[c] += h;
        if (r->sums->each)
            r->sums->each[i].band[c] += h;
        r->light.band[c] = 0.0;
    }
}

/* Adds the variance by rays, without those put aside. */
static void add_variances(struct receiver *r)
{
    double count[2] = {(r->rays + 1) / 2 - r->sums->aside[0],
                       r->rays / 2 - r->sums->aside[1]};
    double all = count[0] + count[1];
    for (int c = 0; c < BANDS && all > 0.0; c++) {
        double mean2 = r->sums->h.band[c] * r->sums->h.band[c] / all, apart = 0.0;
        if (count[0] > 0.0 && count[1] > 0.0)
            apart = 0.5 * all * (r->sums->half[0].band[c] / count[0] -
                                 r->sums->half[1].band[c] / count[1]);
        r->row->chance.band[c] += fmax(0.0, r->sums->squares.band[c] - mean2);
        r->row->halves.band[c] += apart * apart;
    }
}

/* Adds the light of the row's paths to the leaves on which they begin. `factor`: of the
 * paths' weights, and so of the area: else leaves would be seen too bright from afar. */
static void add_paths(struct gather_nears *near, const struct receiver *r, double factor)
{
    double area = factor * r->facet.area;
    for (int64_t i = 0; i < near->path_count; i++) {
        const struct gather_path *path = &near->paths[i];
        struct gather_near *item = &near->items[path->place];
        item->area += gather_units(area / r->rays, near->unit_area);
        for (int c = 0; c < BANDS; c++)
            item->watts[c] += gather_units(area * path->light.band[c], near->unit_watts);
    }
    near->path_count = 0;
}

/* Aims at the bright patches, and makes the light of rays, found without these, the light
 * of all other directions, so the row still sums to 1. `source`, `begin`: of the row, and
 * the number of its sums, before rays were fired. */
static void add_bright(struct receiver *r, struct rgb source, int64_t begin)
{
    struct final_gather *g = r->gather;
    struct gather_sums *sums = g->sums;
    struct rgb after = r->row->source;
    sums->first = sums->count;
    receiver_aim_at_bright(r);
    int aside = r->sums->aside[0] + r->sums->aside[1];
    double rest = fmax(0.0, 1.0 - r->bright) * r->rays;
    double factor = rest / (aside < r->rays ? r->rays - aside : r->rays);
    add_paths(g->near, r, factor);
    for (int64_t i = begin; i < sums->first; i++)
        for (int c = 0; c < BANDS; c++)
            sums->items[i].weight[c] *= factor;
    for (int c = 0; c < BANDS; c++) {
        r->row->source.band[c] += (factor - 1.0) * (after.band[c] - source.band[c]);
        r->sums->h.band[c] =
            factor * r->sums->h.band[c] + r->light.band[c] + r->through.band[c];
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
    r->sums->on_back = r->kind == RECEIVER_ROW &&
                       (r->sums->on_back || meets_backs(r, stream));
}

void receiver_fire(struct receiver *r)
{
    struct sequence sequence = sequence_start(r->seed);
    struct rgb source = r->row->source;
    struct stream stream;
    double share = 1.0 / r->rays;
    int64_t begin = r->gather->sums->first = r->gather->sums->count;
    for (int i = 0; i < r->rays; i++) {
        int half = 2 * i / r->rays, k = i % STREAM_RAYS;
        if (k == 0)
            fill_stream(r, &sequence, i, &stream);
        follow(r, &stream, k, rgb_grey(share), half,
               hash_mix(r->seed ^ hash_mix((uint64_t)i)));
        r->near = -1;
        count_light(r, i, half);
    }
    receiver_find_outside(r);
    if (r->sums->inside == r->rays)
        return; /* the only targets would be walls touched by things */
    add_variances(r);
    add_bright(r, source, begin);
    if (r->escaped < r->rays)
        r->gather->counts.escaped += r->escaped;
}
