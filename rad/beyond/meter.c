/* A light meter.
 *
 * H at a point is a plain row of form factors times the radiosities of the solution:
 * cosine rays find leaves, each with its mean B. Lamps, small and bright, would make it
 * noisy. So the factor of each lamp is exact (Lambert), and segments to points on it tell
 * the share that is seen, each weighted by its kernel. Facets of a sky are lamps.
 *
 * Rays come in BATCHES sequences. Each gives an answer, and the scatter of these tells
 * the deviation of their mean. On top comes the mean error of the leaves met by rays: not
 * less than this mean, since all leaves of a wall may be off together.
 *
 * The rows of the final gather (rad/beyond/gather/row.c) take a tenth of the rays, as
 * leaves of a region share what they learn of its lamps; a point in the air has no
 * region. */
#include "rad/beyond/meter.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/lambert.h"
#include "geom/stop.h"
#include "rad/beyond/sample.h"
#include "rad/beyond/sequence.h"

enum { BATCHES = 8, TRIES = 64 /* for a point of a lamp above the horizon */ };

/* Of the mean of BATCHES: 95 % of a t distribution of 7 degrees of freedom. */
static const double BOUND = 2.365;

/* Height of a point above its surface, relative to the box of all but a sky: points have
 * six digits. */
static const double HEIGHT = 0x1p-22;

/* What is met beyond this part of a segment is the lamp itself, or lies on it. */
static const double WHOLE = 1.0 - 1e-6;

struct meter meter_make(const struct forest *forest, const struct octree *octree,
                        const float *error)
{
    const struct scene *scene = forest->scene;
    struct meter meter = {.forest = forest, .octree = octree, .error = error};
    int32_t roots = scene_root_count(scene);
    struct vec3 low = {0.0, 0.0, 0.0}, high = low;
    bool none = true;
    meter.counts = alloc_array(1, sizeof *meter.counts);
    meter.panes = panes_create(scene);
    meter.lamps = alloc_array((size_t)roots, sizeof *meter.lamps);
    for (int32_t root = 0; root < roots; root++) {
        if (scene_root_area(scene, root) > 0.0 &&
            material_emits(scene_root_material(scene, root)))
            meter.lamps[meter.lamp_count++] = root;
        if (!(scene_root_own_area(scene, root) > 0.0))
            continue;
        struct triangle t = scene_root_triangle(scene, root);
        low = none ? triangle_low(&t) : vec3_least(low, triangle_low(&t));
        high = none ? triangle_high(&t) : vec3_most(high, triangle_high(&t));
        none = false;
    }
    meter.shares = alloc_array((size_t)meter.lamp_count, sizeof *meter.shares);
    meter.height = HEIGHT * vec3_length(vec3_sub(high, low));
    return meter;
}

void meter_free(struct meter *meter)
{
    alloc_free(meter->lamps);
    alloc_free(meter->shares);
    alloc_free(meter->counts);
    panes_destroy(meter->panes);
}

/* The distance of a root's plane along a ray, in units of its direction. */
static double distance_to(const struct scene *scene, int32_t root, struct vec3 from,
                          struct vec3 direction)
{
    struct plane plane = scene_root_plane(scene, root);
    return plane_ahead(&plane, from, direction);
}

/* True if nothing is in the way from x to y, on a lamp. */
static bool sees(const struct meter *meter, struct vec3 x, struct vec3 y, int32_t lamp)
{
    const struct scene *scene = meter->forest->scene;
    struct vec3 d = vec3_sub(y, x);
    struct octree_hit hit;
    if (!octree_first_hit(meter->octree, x, d, false, &hit, meter->counts))
        return true;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    return root == lamp || (root >= 0 && distance_to(scene, root, x, d) > WHOLE);
}

/* Returns the share of a lamp's light that arrives, by `count` segments. */
static struct rgb visible_share(const struct meter *meter, struct vec3 x,
                                struct vec3 normal, int32_t lamp, int count,
                                uint64_t seed)
{
    struct triangle t = scene_root_triangle(meter->forest->scene, lamp);
    struct vec3 facing = scene_root_plane(meter->forest->scene, lamp).normal;
    struct sequence sequence = sequence_start(hash_mix(seed) + (uint64_t)lamp);
    struct rgb seen = {{0.0, 0.0, 0.0}};
    double all = 0.0, u[SEQUENCE_DIMENSIONS];
    int above = 0; /* the horizon */
    for (int i = 0; i < TRIES * count && above < count; i++) {
        sequence_point(&sequence, (uint32_t)i, u);
        struct vec3 y = triangle_of_square(&t, u[0], u[1]);
        double kernel = point_kernel(x, normal, y, facing);
        struct rgb weight = rgb_grey(kernel);
        above += kernel > 0.0;
        all += kernel;
        if (!(kernel > 0.0) || !sees(meter, x, y, lamp))
            continue;
        panes_filter(meter->panes, pane_walk_to(x, y), &weight, meter->counts);
        rgb_add(&seen, 1.0, weight);
    }
    for (int c = 0; c < BANDS && all > 0.0; c++)
        seen.band[c] /= all;
    return seen;
}

/* Returns the light of all but lamps by a sequence of rays. Adds the error of the leaves
 * met to `*error`. */
static struct rgb read_rest(const struct meter *meter, struct vec3 x, struct vec3 normal,
                            int rays, uint64_t seed, double *error)
{
    const struct forest *forest = meter->forest;
    const struct scene *scene = forest->scene;
    struct sequence sequence = sequence_start(seed);
    struct vec3 along = direction_along(normal);
    struct rgb sum = {{0.0, 0.0, 0.0}};
    double u[SEQUENCE_DIMENSIONS], at[3];
    for (int i = 0; i < rays; i++) {
        struct octree_hit hit;
        sequence_point(&sequence, (uint32_t)i, u);
        struct vec3 d = cosine_direction(normal, along, u[0], u[1]);
        bool met = octree_first_hit(meter->octree, x, d, false, &hit, meter->counts);
        int32_t root = met ? scene_root_on(scene, hit.triangle, hit.front) : -1;
        double far = root >= 0 ? distance_to(scene, root, x, d) : HUGE_VAL;
        struct rgb weight = rgb_grey(1.0 / rays);
        struct pane_walk walk = {x, d, far, -1};
        panes_cross(meter->panes, walk, forest, &weight, &sum, meter->counts);
        if (root < 0)
            continue;
        struct vec3 y = vec3_add(x, vec3_scale(d, far));
        int32_t leaf = leaf_under(forest, root, y, at);
        struct rgb emission = scene_root_material(scene, root)->emission;
        struct rgb reflected = rgb_sub(forest->radiosity[leaf], emission);
        rgb_add(&sum, 1.0, rgb_times(weight, reflected));
        *error += meter->error ? (double)meter->error[leaf] / rays : 0.0;
    }
    return sum;
}

struct metered meter_read(const struct meter *meter, struct vec3 x, struct vec3 normal,
                          int rays, uint64_t seed)
{
    const struct scene *scene = meter->forest->scene;
    int each = (rays + BATCHES - 1) / BATCHES;
    struct metered reading = {.error = 0.0};
    struct rgb square = {{0.0, 0.0, 0.0}};
    double all = 0.0, off = 0.0, variance = 0.0;
    x = vec3_add(x, vec3_scale(normal, meter->height));
    for (int64_t k = 0; k < meter->lamp_count; k++) {
        struct triangle t = scene_root_triangle(scene, meter->lamps[k]);
        meter->shares[k] = point_triangle_factor(x, normal, &t);
        all += meter->shares[k] *
               rgb_sum(scene_root_material(scene, meter->lamps[k])->emission);
    }
    for (int batch = 0; batch < BATCHES && !stop_is_asked(); batch++) {
        uint64_t own = hash_mix(seed * BATCHES + (uint64_t)batch);
        struct rgb lamps = {{0.0, 0.0, 0.0}};
        struct rgb light = read_rest(meter, x, normal, each, own, &off);
        for (int64_t k = 0; k < meter->lamp_count; k++) {
            struct rgb e = scene_root_material(scene, meter->lamps[k])->emission;
            double factor = meter->shares[k], part = factor * rgb_sum(e) / all;
            if (!(factor > 0.0))
                continue;
            struct rgb seen = visible_share(meter, x, normal, meter->lamps[k],
                                            1 + (int)(part * each), own);
            rgb_add(&lamps, 1.0, rgb_times(rgb_scale(seen, factor), e));
        }
        rgb_add(&light, 1.0, lamps);
        rgb_add(&reading.lamps, 1.0 / BATCHES, lamps);
        rgb_add(&reading.irradiance, 1.0 / BATCHES, light);
        rgb_add(&square, 1.0 / BATCHES, rgb_times(light, light));
    }
    for (int c = 0; c < BANDS; c++) {
        double mean = reading.irradiance.band[c];
        variance = real_max(variance, square.band[c] - mean * mean);
    }
    off /= BATCHES;
    reading.error = sqrt(BOUND * BOUND * variance / (BATCHES - 1) + off * off);
    return reading;
}
