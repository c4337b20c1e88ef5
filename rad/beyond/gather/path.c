/* Paths from near surfaces.
 *
 * The mesh is wrong where a ray ends nearer than the leaf there is large: under a sheet
 * of paper on a table the table is dark, but the leaf is not. There the ray goes on: the
 * point met receives light from a lamp, by one segment, and from one more ray, until a
 * ray ends far enough away: a path tracer for near surfaces, and radiosity for the rest.
 * One more ray is aimed at a pane: else single leaves shine. In pixels one ray is aimed
 * at a bright patch from there, too: else single pixels shine along all edges of a
 * room. */
#include "rad/beyond/gather/path.h"

#include <math.h>

#include "geom/hash.h"
#include "geom/lambert.h"
#include "rad/beyond/gather/pane.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

/* Most points of a path; those from which paths go on in any case. */
enum { PATH_MOST = 256, PATH_SURE = 2 };

/* True if the point met by a path is of a lamp, which is aimed at from x on its way. */
static bool is_aimed_lamp(const struct receiver *r, const struct point *met,
                          struct vec3 x)
{
    if (!root_is_lamp(r->gather, met->root))
        return false;
    struct triangle t = scene_root_triangle(r->gather->model->scene, met->root);
    return !point_is_beside(x, &t);
}

/* Russian roulette. The path goes on with a probability p, the largest reflectance, and
 * then has 1 / p of its weight. One that ends gets the mesh's light; from one that goes
 * on as much of this light is taken as its weight has grown by. So rows still sum to 1.
 * This is noise where the mesh is far from right, as in the shade at the edge of a wide
 * bright leaf, so the first points do without. Deep in a gap between bright surfaces
 * paths are long: if they ended soon with the mesh's light, the mean of inside and
 * outside, gaps would shine. Rejected: ending half of the longest and giving their light
 * to the others; the light then taken off the mesh makes large rows of both signs, by
 * which light at rho .999 is not found. */
static bool survives(struct receiver *r, const struct point *point, bool aimed, double u,
                    struct rgb *weight)
{
    double most =
        rgb_most(forest_material(r->gather->model->forest, point->patch)->reflectance);
    struct rgb rest = *weight;
    if (u < most) {
        for (int c = 0; c < BANDS; c++) {
            weight->band[c] /= most;
            rest.band[c] -= weight->band[c];
        }
    }
    path_add_mesh(r, point, aimed, &rest);
    return u < most;
}

/* A point of a sender. */
struct sender_point {
    int32_t root;
    struct vec3 at;
    double share; /* form factor of the sender over the probability of its choice, 1 */
};

/* Chooses a sender by the cut of a patch beside the leaf, and a point of it above the
 * horizon of x, by hashes. False if the point is not visible, or its light is brought by
 * a pane on the way. */
static bool choose_beside(struct receiver *r, struct cuts *cuts, struct vec3 x,
                          struct vec3 normal, int32_t patch, uint64_t seed,
                          struct sender_point *target)
{
    const struct forest *forest = r->gather->model->forest;
    const struct scene *scene = forest->scene;
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
        struct pane_walk walk = receiver_walk_to(r, point_above(x, normal), y);
        return !segment_is_stopped(r, x, input, y, sender.patch) &&
               !receiver_puts_aside(r, walk, pane ? sender.patch : -1);
    }
    return false;
}

/* Adds `weight` times the light of one lamp at a point met. */
static void aim_beside(struct receiver *r, const struct point *point,
                       const struct rgb *weight, uint64_t seed)
{
    const struct final_gather *g = r->gather;
    struct rgb light = *weight;
    struct sender_point lamp;
    if (!choose_beside(r, g->aims->cuts[LAMPS], point->at, point->normal, point->patch,
                       seed, &lamp))
        return;
    struct vec3 x = point_above(point->at, point->normal);
    receiver_filter(r, receiver_walk_to(r, x, lamp.at), &light);
    receiver_add_source(r, &light,
                        scene_root_material(g->model->scene, lamp.root)->emission,
                        lamp.share);
}

/* A path goes on from the point met: adds the emission, unless `aimed` at, and the light
 * of a lamp, and makes a ray of the seed's. False if the point absorbs all. */
static bool leave(struct receiver *r, const struct point *point, bool aimed,
                  uint64_t seed, struct rgb *weight, struct vec3 *origin,
                  struct vec3 *direction)
{
    const struct material *material =
        forest_material(r->gather->model->forest, point->patch);
    if (!aimed)
        receiver_add_source(r, weight, material->emission, 1.0);
    *weight = rgb_times(*weight, material->reflectance);
    if (!(rgb_sum(*weight) > 0.0))
        return false;
    aim_beside(r, point, weight, seed);
    *origin = point_above(point->at, point->normal);
    *direction = cosine_direction(point->normal, direction_along(point->normal),
                                  hash_unit(seed + 14), hash_unit(seed + 15));
    return true;
}

bool path_is_aimed_at(const struct receiver *r, const struct point *met, struct vec3 x)
{
    int32_t bright = r->gather->aims->senders[BRIGHT_PATCHES]->part_of[met->patch];
    if (bright < 0)
        return false;
    struct triangle t = forest_triangle(r->gather->model->forest, bright);
    return !point_is_beside(x, &t) && (r->kind == RECEIVER_PIXEL || path_ends(r, met, x));
}

/* True if look_beside(), from the point x of a path, brings the light of the bright patch
 * at `met`, and rays do not. That is so in pixels, if a point chosen by power on all
 * bright patches brings no more than a ray. (A row would not sum to 1.) */
static bool is_aimed_at_beside(const struct receiver *r, const struct point *met,
                               struct vec3 x)
{
    const struct senders *bright = r->gather->aims->senders[BRIGHT_PATCHES];
    int32_t patch = bright->part_of[met->patch];
    if (r->kind != RECEIVER_PIXEL || patch < 0)
        return false;
    struct vec3 ray = vec3_sub(met->at, x);
    double sent = rgb_sum(sender_light(bright, patch));
    return PI * vec3_dot(ray, ray) * sent >= senders_power(bright);
}

/* Adds `weight` times the light of such patches, by one ray from x. */
static void look_beside(struct receiver *r, struct vec3 x, struct vec3 normal,
                        const struct rgb *weight, uint64_t seed)
{
    const struct senders *senders = r->gather->aims->senders[BRIGHT_PATCHES];
    if (r->kind != RECEIVER_PIXEL || !(senders_power(senders) > 0.0))
        return;
    struct choice bright = sender_choose(senders, senders->nodes, hash_unit(seed));
    struct facet facet = facet_make(r->gather->model->forest, bright.patch);
    struct vec3 y =
        triangle_of_square(&facet.triangle, hash_unit(seed + 1), hash_unit(seed + 2));
    double factor =
        bright.share * facet.area * point_kernel(x, normal, y, facet.plane.normal);
    struct point point;
    if (!(factor > 0.0) ||
        trace(r, x, vec3_unit(vec3_sub(y, x)), &point) != MET_FRONT ||
        senders->part_of[point.patch] != bright.patch ||
        !is_aimed_at_beside(r, &point, x))
        return;
    struct rgb light = rgb_scale(*weight, factor);
    struct pane_walk walk = receiver_walk_to(r, x, point.at);
    if (receiver_puts_aside(r, walk, -1))
        return;
    receiver_cross(r, walk, &light);
    path_go_on(r, point, x, is_aimed_lamp(r, &point, x), light, hash_mix(seed), false);
}

/* Adds the light of the bright patch at its point y, if rays from x are aimed at it. */
static void see_bright(struct receiver *r, struct vec3 x, struct vec3 y, int32_t patch,
                       struct pane_walk walk, double factor, uint64_t seed)
{
    const struct forest *forest = r->gather->model->forest;
    int32_t root = (int32_t)forest->patches[patch].id.root;
    struct point point = {.root = root, .at = y,
                          .normal = scene_root_plane(forest->scene, root).normal};
    find_leaf(forest, &point);
    if (!path_is_aimed_at(r, &point, x))
        return;
    struct rgb weight = rgb_grey(factor);
    r->bright += factor;
    receiver_cross(r, walk, &weight);
    path_go_on(r, point, x, root_is_lamp(r->gather, root), weight, seed, true);
}

/* Adds `weight` times the light seen from x through the point y of a pane. Returns the
 * part straight from a lamp. */
static struct rgb see_through(struct receiver *r, struct vec3 x, struct vec3 y,
                              struct rgb weight, uint64_t seed, bool aims)
{
    struct final_gather *g = r->gather;
    struct vec3 direction = vec3_unit(vec3_sub(y, x));
    struct rgb straight = {{0.0, 0.0, 0.0}};
    struct point point;
    enum met met = trace(r, x, direction, &point);
    struct pane_walk walk = receiver_walk(r, x, direction, met, &point);
    bool lamp = met == MET_FRONT && root_is_lamp(g, point.root);
    if (r->lamps_alone)
        receiver_filter(r, walk, &weight);
    else
        receiver_cross(r, walk, &weight);
    if (lamp) {
        straight = forest_material(g->model->forest, point.patch)->emission;
        receiver_add_source(r, &weight, straight, 1.0);
        straight = rgb_times(straight, weight);
    }
    if (met == MET_FRONT && !r->lamps_alone)
        path_go_on(r, point, y, lamp, weight, seed, aims);
    return straight;
}

void receiver_see(struct receiver *r, const struct senders *senders, struct vec3 x,
                  struct vec3 y, int32_t patch, double factor, uint64_t seed)
{
    bool window = senders->kind == WINDOWS;
    struct rgb weight = rgb_grey(1.0);
    struct vec3 above = point_above(x, r->facet.plane.normal);
    struct pane_walk walk = receiver_walk_to(r, above, y);
    if (receiver_puts_aside(r, walk, window ? patch : -1))
        return;
    if (window) {
        r->bright += factor;
        rgb_add(&r->row->straight, 1.0,
                see_through(r, above, y, rgb_grey(factor), seed, true));
    } else if (senders->kind == BRIGHT_PATCHES) {
        see_bright(r, x, y, patch, walk, factor, seed);
    } else {
        receiver_filter(r, walk, &weight);
        receiver_add_source(r, &weight, sender_light(senders, patch), factor);
    }
}

/* Adds `weight` times the light behind panes, by one ray to one of them from x, just
 * above the point. */
static void look_through(struct receiver *r, const struct point *point, struct vec3 x,
                         struct rgb weight, uint64_t seed)
{
    struct sender_point pane;
    if (!r->gather->aims->panes ||
        !choose_beside(r, r->gather->aims->cuts[WINDOWS], point->at, point->normal,
                       point->patch, seed, &pane))
        return;
    weight = rgb_scale(weight, pane.share);
    see_through(r, x, pane.at, weight, hash_mix(seed + 1), false);
}

void path_go_on(struct receiver *r, struct point point, struct vec3 x, bool aimed,
                struct rgb weight, uint64_t seed, bool aims)
{
    for (int count = 1; count < PATH_MOST && !path_ends(r, &point, x);
         count++, seed += 16) {
        struct vec3 direction, normal = point.normal;
        if (count > PATH_SURE &&
            !survives(r, &point, aimed, hash_unit(seed + 13), &weight))
            return;
        if (!leave(r, &point, aimed, seed, &weight, &x, &direction))
            return;
        if (aims) {
            look_beside(r, x, normal, &weight, seed + 10);
            look_through(r, &point, x, weight, hash_mix(seed));
        }
        enum met met = trace(r, x, direction, &point);
        r->escaped += met != MET_FRONT;
        struct pane_walk walk = receiver_walk(r, x, direction, met, &point);
        bool through = receiver_puts_aside(r, walk, -1);
        if (through && aims)
            return;
        receiver_cross(r, walk, &weight);
        if (met != MET_FRONT)
            return;
        aimed = !through && is_aimed_lamp(r, &point, x);
        if (aims && is_aimed_at_beside(r, &point, x))
            return;
    }
    path_add_mesh(r, &point, aimed, &weight);
}
