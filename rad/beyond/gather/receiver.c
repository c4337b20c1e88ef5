/* A receiver: a leaf, or points of a pixel. Light of the mesh is added to its terms,
 * light of lamps to its source, and both to the light of the ray at hand. */
#include "rad/beyond/gather/receiver.h"

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/sample.h"

/* A receiver on a patch. Rays beyond the points of a sequence would be the same. */
static struct receiver receiver_make(struct final_gather *gather, enum receiver_kind kind,
                                     struct facet facet, uint64_t seed, int rays,
                                     struct gather_row *row, struct ray_sums *sums)
{
    rays = rays < SEQUENCE_POINTS ? rays : SEQUENCE_POINTS;
    return (struct receiver){.kind = kind, .gather = gather, .facet = facet,
                             .seed = seed, .row = row, .sums = sums,
                             .along = direction_along(facet.plane.normal), .rays = rays,
                             .segments = rays, .near = -1};
}

struct receiver receiver_of_leaf(struct final_gather *gather, enum receiver_kind kind,
                                 int rays, struct gather_row *row, struct ray_sums *sums)
{
    const struct forest *forest = gather->model->forest;
    uint64_t seed = hash_mix(id_number(forest->patches[row->leaf].id));
    return receiver_make(gather, kind, facet_make(forest, row->leaf), seed, rays, row,
                         sums);
}

struct receiver receiver_of_points(struct final_gather *gather,
                                   const struct gather_points *points, uint64_t seed,
                                   int rays, struct gather_row *row,
                                   struct ray_sums *sums)
{
    struct vec3 x = points->middle;
    struct facet facet = {.triangle = {{x, x, x}},
                          .plane = points->plane,
                          .input = scene_input_of(gather->model->scene, points->root)};
    struct receiver r = receiver_make(gather, RECEIVER_PIXEL, facet, hash_mix(seed), rays,
                                      row, sums);
    r.points = points;
    return r;
}

/* The sum of the row at hand for a patch, by way of the leaf that its ray met first. */
static struct gather_sum *sum_of(struct final_gather *g, int32_t place, int32_t near)
{
    struct gather_sums *sums = g->sums;
    int32_t at = sums->latest[place];
    if (at >= sums->first && at < sums->count && sums->items[at].place == place &&
        sums->items[at].near == near)
        return &sums->items[at];
    RESERVE(sums->items, &sums->capacity, sums->count + 1);
    sums->latest[place] = (int32_t)sums->count;
    sums->items[sums->count] = (struct gather_sum){.place = place, .near = near};
    return &sums->items[sums->count++];
}

/* Adds `weight` times the mean radiosity of a patch. */
static void add_patch(struct receiver *r, int32_t patch, const struct rgb *weight)
{
    struct final_gather *g = r->gather;
    rgb_add(&r->light, 1.0, rgb_times(*weight, g->model->forest->radiosity[patch]));
    if (r->kind != RECEIVER_ROW)
        return;
    struct gather_sum *sum = sum_of(g, g->place[patch], r->near);
    for (int c = 0; c < BANDS; c++)
        sum->weight[c] += weight->band[c];
}

void receiver_add_point(struct receiver *r, int32_t patch,
                        const struct gather_slope *slope, const double at[3],
                        const struct rgb *weight)
{
    add_patch(r, patch, weight);
    struct rgb steep = rgb_scale(*weight, slope->rise);
    for (int k = 0; k < 3 && slope->rise != 0.0; k++) {
        struct rgb part = rgb_scale(steep, at[k] - 1.0 / 3.0);
        add_patch(r, slope->first + k, &part);
    }
}

void receiver_add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor)
{
    const struct gather_nears *near = r->gather->near;
    if (r->near >= 0)
        rgb_add(&near->paths[near->path_count - 1].light, 1.0,
                rgb_times(rgb_scale(*weight, factor), emission));
}

void receiver_add_source(struct receiver *r, const struct rgb *weight,
                         struct rgb emission, double factor)
{
    receiver_add_near(r, weight, emission, factor);
    struct rgb h = rgb_times(rgb_scale(*weight, factor), emission);
    rgb_add(&r->row->source, 1.0, h);
    rgb_add(&r->light, 1.0, h);
}

bool segment_is_stopped(struct receiver *r, struct vec3 from, int32_t input,
                        struct vec3 to, int32_t root)
{
    struct model *model = r->gather->model;
    int32_t own[2] = {input, scene_input_of(model->scene, root)}, guess = -1;
    r->gather->counts.segments++;
    return octree_blocks_segment(model->octree, from, to, own, &guess, &model->counts);
}

bool receiver_is_blocked(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root)
{
    int32_t input = r->facet.input;
    if (r->points && r->points->above) {
        const struct scene *scene = r->gather->model->scene;
        struct segment segment = segment_make(x, y);
        if (segment_is_blocked_by(&segment, &scene->triangles[input],
                                  &scene->planes[input]))
            return true;
    }
    return segment_is_stopped(r, x, input, y, root);
}
