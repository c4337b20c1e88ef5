/* Segments to lamps: what stands in the way, and one from a point of a path. */
#include "rad/beyond/gather/source.h"

#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/gather/pane.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* The triangle blocking a segment to a sender, or -1. */
static inline int32_t blocker_of(struct receiver *r, struct vec3 from, int32_t input,
                                 struct vec3 to, int32_t root)
{
    int32_t own[2] = {input, scene_input_of(r->gather->model->scene, root)}, guess = -1;
    r->gather->counts.segments++;
    return octree_blocks_segment(r->gather->model->octree, from, to, own, &guess,
                                 &r->gather->model->counts)
               ? guess
               : -1;
}

int32_t receiver_blocker(struct receiver *r, struct vec3 x, struct vec3 y, int32_t root)
{
    int32_t input = r->facet.input;
    if (r->points && r->points->above) {
        const struct scene *scene = r->gather->model->scene;
        struct segment segment = segment_make(x, y);
        if (segment_is_blocked_by(&segment, &scene->triangles[input],
                                  &scene->planes[input]))
            return input;
    }
    return blocker_of(r, x, input, y, root);
}

bool receiver_choose_beside(struct receiver *r, struct cuts *cuts, struct vec3 x,
                            struct vec3 normal, int32_t patch, uint64_t seed,
                            struct sender_point *target)
{
    struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    const struct scene *scene = g->model->scene;
    int32_t input = scene_input_of(scene, (int32_t)forest->patches[patch].id.root);
    struct cut cut = cuts_at(cuts, patch);
    struct choice sender = cuts_choose(cuts, cut, hash_unit(seed));
    if (sender.patch < 0)
        return false;
    struct triangle triangle = scene_root_triangle(scene, sender.patch);
    bool pane = cuts->senders->kind == WINDOWS;
    if (!pane && point_is_beside(x, &triangle))
        return false;
    struct vec3 facing = scene_root_plane(scene, sender.patch).normal, y;
    double factor = point_triangle_factor(x, normal, &triangle);
    uint64_t at = seed + 2;
    for (int k = 0; k < TRIES_MOST && factor > 0.0; k++, at = hash_mix(at)) {
        y = triangle_of_square(&triangle, hash_unit(at), hash_unit(at + 1));
        if (!(point_kernel(x, normal, y, facing) > 0.0))
            continue;
        *target = (struct sender_point){sender.patch, y, factor * sender.share};
        return blocker_of(r, x, input, y, sender.patch) < 0 &&
               (!g->aims->panes ||
                !receiver_puts_aside(r, pane_walk_to(point_above(x, normal), y),
                                     pane ? sender.patch : -1));
    }
    return false;
}

void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed)
{
    struct final_gather *g = r->gather;
    struct rgb light = *weight;
    struct sender_point lamp;
    if (!receiver_choose_beside(r, g->aims->cuts[LAMPS], x, normal, patch, seed, &lamp))
        return;
    if (g->aims->panes)
        receiver_filter(r, pane_walk_to(point_above(x, normal), lamp.at), &light);
    receiver_add_source(r, &light,
                        scene_root_material(g->model->scene, lamp.root)->emission,
                        lamp.share);
}
