/* The light of lamps as a source: what a receiver is given, what stands in the way, and
 * one segment from a point of a path beside it. */
#include "rad/beyond/gather/receiver.h"

#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

void receiver_add_near(struct receiver *r, const struct rgb *weight, struct rgb emission,
                       double factor)
{
    struct gather_nears *near = r->gather->near;
    for (int c = 0; c < BANDS && r->near >= 0; c++)
        near->paths[near->path_count - 1].light.band[c] +=
            weight->band[c] * factor * emission.band[c];
}

void receiver_add_source(struct receiver *r, const struct rgb *weight,
                         struct rgb emission, double factor)
{
    receiver_add_near(r, weight, emission, factor);
    for (int c = 0; c < BANDS; c++) {
        double h = weight->band[c] * factor * emission.band[c];
        r->row->source.band[c] += h;
        r->light.band[c] += h;
    }
}

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

bool point_is_beside(struct vec3 x, const struct triangle *sender)
{
    struct vec3 apart = vec3_sub(triangle_centroid(sender), x);
    double radius = triangle_radius(sender);
    return vec3_dot(apart, apart) < radius * radius;
}

/* The lamp is chosen by the cut of the patch's region, a point of it above the horizon by
 * hashes. */
void receiver_aim_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                         int32_t patch, const struct rgb *weight, uint64_t seed)
{
    struct final_gather *g = r->gather;
    const struct forest *forest = g->model->forest;
    const struct scene *scene = g->model->scene;
    int32_t input = scene_input_of(scene, (int32_t)forest->patches[patch].id.root);
    struct cut cut = cuts_at(g->aims->lamp_cuts, patch, &g->view->counts);
    struct choice lamp = cuts_choose(g->aims->lamp_cuts, cut, hash_unit(seed));
    if (lamp.patch < 0)
        return;
    struct triangle triangle = scene_root_triangle(scene, lamp.patch);
    if (point_is_beside(x, &triangle))
        return;
    struct vec3 facing = scene_root_plane(scene, lamp.patch).normal;
    struct rgb emission = scene_root_material(scene, lamp.patch)->emission;
    double factor = point_triangle_factor(x, normal, &triangle);
    uint64_t at = seed + 2;
    for (int k = 0; k < TRIES_MOST && factor > 0.0; k++, at = hash_mix(at)) {
        struct vec3 y = triangle_of_square(&triangle, hash_unit(at), hash_unit(at + 1));
        if (!(point_kernel(x, normal, y, facing) > 0.0))
            continue;
        if (blocker_of(r, x, input, y, lamp.patch) < 0)
            receiver_add_source(r, weight, emission, factor * lamp.share);
        return;
    }
}
