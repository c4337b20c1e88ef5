/* The path tracer.
 *
 * The radiosity of a surface is B = E + rho H with the irradiance
 *
 *     H(x) = integral over y of  G(x, y) V(x, y) (E(y) + rho(y) H(y)) dA(y),
 *     G(x, y) = cos cos' / (pi r^2).
 *
 * A path goes from x in a direction whose density is the cosine over pi. Where it
 * arrives, at y, the density by area is G(x, y) itself: nothing but rho(y) remains as its
 * factor. It goes on with the probability of y's largest reflectance. A miss or a back
 * ends it; a back with a twin is the front of the twin.
 *
 * A guess S(y) at the reflected radiosity takes noise from this chance: with the
 * probability q of going on,
 *
 *     rho H  =  S  +  (rho H - S) / q  with the probability q, else S,
 *
 * in the mean, whatever S is. Where S is right, a path of a bright room brings nearly the
 * same light however long it is; else light in proportion to its length.
 *
 * Emission is found in two ways, by a point chosen on the lights (by power, evenly over
 * the area of one: a density L(y) of its emission, all bands, over all power) with a
 * shadow segment, and by the paths meeting a light. Each light path is counted with the
 * share of the way of its finding, L / (L + G) and G / (L + G) (the balance heuristic of
 * Veach and Guibas, SIGGRAPH 1995), so the shares add up to 1 and nothing is counted
 * twice. Rejected: the lights alone. G has no bound where a light touches a surface, nor
 * has the variance there; here both terms are at most the light's own E.
 *
 * A ray crosses a pane, or ends there, with probabilities like those of its largest
 * transmittance and reflectance, and has 1 over that as a factor; a segment to a light is
 * multiplied by the transmittances of all panes.
 *
 * A light path goes the other way: from a point of the lights, chosen as above, in a
 * direction whose density is the cosine over pi, from surface to surface with the same
 * chances of going on. Light paths reach all the surfaces of a scene at once, which is
 * the cheaper way to the means of many elements; no light path meets a given point.
 *
 * The first seven numbers of a path (its start, or its place in a pixel, its first light
 * point, its first direction) are those of a lattice moved by a random vector: sample i
 * has shift + i * step, modulo 1, in each dimension. Each sample alone is uniform, so the
 * mean is exact whatever the lattice; spread evenly, samples take away most of the noise.
 * The step is by Roberts: powers of 1 / g with g^8 = g + 1. The rest of the path is plain
 * random numbers, and so are light paths: a lattice would correlate the errors of all
 * elements. */
#include "rad/beyond/paths.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/beyond/sequence.h"

/* --- numbers in [0, 1) --- */

enum { DIMENSIONS = 7 };

static const double STEP[DIMENSIONS] = {
    0.9115923534820549, 0.8310006189269519, 0.7575338099526643, 0.690562028656977,
    0.629511064928756, 0.5738574732213994, 0.5231240845771608};

struct draw {
    uint64_t next; /* seed of the next plain number */
    double shift[DIMENSIONS];
    int sample; /* number of the path */
    int used;   /* numbers taken by the path */
};

/* Neighbouring seeds must not give related numbers. */
static struct draw draw_make(uint64_t seed)
{
    struct draw draw = {.next = hash_mix(hash_mix(seed))};
    for (int k = 0; k < DIMENSIONS; k++)
        draw.shift[k] = hash_unit(draw.next++);
    return draw;
}

static double draw_next(struct draw *draw)
{
    int k = draw->used++;
    if (k >= DIMENSIONS)
        return hash_unit(draw->next++);
    double moved = draw->shift[k] + draw->sample * STEP[k];
    return moved - (double)(int64_t)moved;
}

/* --- points and directions --- */

static struct vec3 point_on(const struct triangle *t, struct draw *draw)
{
    double u = draw_next(draw), v = draw_next(draw);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    return corners_mean(t->corner, (struct vec3){1.0 - u - v, u, v});
}

struct triangle pathtracer_part(struct patch_id id)
{
    struct triangle part = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int step = 0; step < id_level(id); step++)
        part = triangle_child(&part, id_step(id, step));
    return part;
}

/* --- light --- */

/* The end of a ray on a front. */
struct arrival {
    struct vec3 x;
    int32_t root;
};

/* Finds where the ray arrives. False for a miss or a black back. */
static bool arrive(const struct pathtracer *pathtracer, struct vec3 origin,
                   struct vec3 direction, bool fronts_only, struct arrival *q)
{
    struct octree_hit hit;
    if (!octree_first_hit(pathtracer->octree, origin, direction, fronts_only, &hit,
                          pathtracer->counts))
        return false;
    const struct plane *plane = &pathtracer->scene->planes[hit.triangle];
    q->root = scene_root_on(pathtracer->scene, hit.triangle, hit.front);
    q->x = vec3_add(origin, vec3_scale(direction, plane_ahead(plane, origin, direction)));
    return q->root >= 0;
}

/* A lamp in the plane of its ceiling, and earlier in the file, has another face on top,
 * which rays meet in its place; segments look through this face. */
static void find_hidden(struct pathtracer *pathtracer)
{
    const struct scene *scene = pathtracer->scene;
    int32_t roots = scene_root_count(scene);
    pathtracer->hidden = alloc_array((size_t)roots, sizeof *pathtracer->hidden);
    for (int32_t r = 0; r < roots; r++) {
        if (!(scene_root_area(scene, r) > 0.0) ||
            !(rgb_sum(scene_root_material(scene, r)->emission) > 0.0))
            continue;
        struct triangle lamp = scene_root_triangle(scene, r);
        struct vec3 down = scene_root_plane(scene, r).normal;
        struct vec3 above = point_above(triangle_centroid(&lamp), down);
        struct arrival met;
        bool meets = arrive(pathtracer, above, vec3_scale(down, -1.0), false, &met);
        pathtracer->hidden[r] = meets && met.root != r;
    }
}

/* Emission of a root, over bands, times its favour, W/m^2. */
static double favoured(const struct pathtracer *pathtracer, int32_t root)
{
    double emission = rgb_sum(scene_root_material(pathtracer->scene, root)->emission);
    return pathtracer->favour ? pathtracer->favour[root] * emission : emission;
}

void pathtracer_favour(struct pathtracer *pathtracer, const double *favour)
{
    double sum = 0.0;
    pathtracer->favour = favour;
    for (int32_t r = 0; r < scene_root_count(pathtracer->scene); r++)
        pathtracer->power[r] = sum +=
            scene_root_area(pathtracer->scene, r) * favoured(pathtracer, r);
}

struct pathtracer pathtracer_make(const struct scene *scene, const struct octree *octree)
{
    struct pathtracer pathtracer = {.scene = scene, .octree = octree};
    pathtracer.counts = alloc_array(1, sizeof *pathtracer.counts);
    pathtracer.panes = panes_create(scene);
    int32_t roots = scene_root_count(scene);
    pathtracer.power = alloc_array((size_t)roots, sizeof *pathtracer.power);
    pathtracer_favour(&pathtracer, NULL);
    find_hidden(&pathtracer);
    return pathtracer;
}

void pathtracer_free(struct pathtracer *pathtracer)
{
    alloc_free(pathtracer->power);
    alloc_free(pathtracer->hidden);
    panes_destroy(pathtracer->panes);
    alloc_free(pathtracer->counts);
    *pathtracer = (struct pathtracer){.scene = NULL};
}

double pathtracer_power(const struct pathtracer *pathtracer)
{
    return pathtracer->power[scene_root_count(pathtracer->scene) - 1];
}

/* A root, chosen by its emitted power. */
static int32_t choose_light(const struct pathtracer *pathtracer, struct draw *draw)
{
    return (int32_t)sum_place(pathtracer->power, scene_root_count(pathtracer->scene),
                              pathtracer_power(pathtracer) * draw_next(draw));
}

/* G, 1 / square scene unit; 0 where one of the two faces away. */
static double coupling(const struct pathtracer *pathtracer, const struct arrival *p,
                       const struct arrival *q)
{
    return point_kernel(p->x, scene_root_plane(pathtracer->scene, p->root).normal, q->x,
                        scene_root_plane(pathtracer->scene, q->root).normal);
}

static bool is_blocked(const struct pathtracer *pathtracer, const struct arrival *p,
                       const struct arrival *q)
{
    const int32_t own[2] = {scene_input_of(pathtracer->scene, p->root),
                            scene_input_of(pathtracer->scene, q->root)};
    int32_t guess = -1;
    return octree_blocks_segment(pathtracer->octree, p->x, q->x, own, &guess,
                                 pathtracer->counts);
}

/* sum += throughput * factor * colour, band by band. */
static void add_light(struct rgb *sum, struct rgb throughput, double factor,
                      struct rgb colour)
{
    rgb_add(sum, 1.0, rgb_times(rgb_scale(throughput, factor), colour));
}

/* Irradiance from a point chosen on the lights. */
static void add_chosen_light(const struct pathtracer *pathtracer, const struct arrival *p,
                             struct rgb throughput, struct draw *draw, struct rgb *sum)
{
    const struct scene *scene = pathtracer->scene;
    double power = pathtracer_power(pathtracer);
    struct arrival light = {.root = choose_light(pathtracer, draw)};
    struct triangle t = scene_root_triangle(scene, light.root);
    light.x = point_on(&t, draw);
    struct rgb emission = scene_root_material(scene, light.root)->emission;
    double g = coupling(pathtracer, p, &light);
    double density = favoured(pathtracer, light.root) / power;
    double both = density + (pathtracer->hidden[light.root] ? 0.0 : g);
    if (!(g > 0.0) || is_blocked(pathtracer, p, &light))
        return;
    struct vec3 up = scene_root_plane(scene, p->root).normal;
    struct pane_walk walk = pane_walk_to(point_above(p->x, up), light.x);
    panes_filter(pathtracer->panes, walk, &throughput, pathtracer->counts);
    add_light(sum, throughput, g / both, emission);
}

/* Irradiance from the light met by a path. */
static void add_met_light(const struct pathtracer *pathtracer, const struct arrival *p,
                          const struct arrival *q, struct rgb throughput, struct rgb *sum)
{
    struct rgb emission = scene_root_material(pathtracer->scene, q->root)->emission;
    if (!(rgb_sum(emission) > 0.0) || pathtracer->hidden[q->root])
        return;
    double density = favoured(pathtracer, q->root) / pathtracer_power(pathtracer);
    double g = coupling(pathtracer, p, q);
    if (g > 0.0)
        add_light(sum, throughput, g / (density + g), emission);
}

/* --- paths --- */

/* Finds where a ray arrives, on a blocker or a pane. False for neither. */
static bool travel(const struct pathtracer *pathtracer, struct half_line ray,
                   bool fronts_only, struct draw *draw, struct rgb *throughput,
                   struct arrival *q)
{
    bool arrives = arrive(pathtracer, ray.origin, ray.direction, fronts_only, q);
    struct pane_walk walk = {ray.origin, ray.direction, HUGE_VAL, -1};
    if (arrives)
        walk.left = vec3_length(vec3_sub(q->x, ray.origin));
    const struct panes *panes = pathtracer->panes;
    while (panes && panes_next(panes, &walk, pathtracer->counts)) {
        const struct material *pane = scene_root_material(pathtracer->scene, walk.root);
        double rho = rgb_most(pane->reflectance);
        double ends = rho / (rho + rgb_most(pane->transmittance));
        bool on = !(rho > 0.0) || hash_unit(draw->next++) >= ends;
        if (on)
            pane_filter(pathtracer->scene, walk.root, throughput);
        for (int c = 0; c < BANDS; c++)
            throughput->band[c] /= on ? 1.0 - ends : ends;
        if (!on) {
            *q = (struct arrival){walk.at, walk.root};
            return true;
        }
    }
    return arrives;
}

/* Finds where a ray from a surface arrives, in a direction whose density is its cosine to
 * the normal over pi. False for a miss or a black back. */
static bool follow(const struct pathtracer *pathtracer, const struct arrival *p,
                   struct draw *draw, struct rgb *throughput, struct arrival *q)
{
    struct vec3 normal = scene_root_plane(pathtracer->scene, p->root).normal;
    double u = draw_next(draw), v = draw_next(draw);
    struct vec3 direction = cosine_direction(normal, direction_along(normal), u, v);
    struct half_line ray = {point_above(p->x, normal), direction};
    return travel(pathtracer, ray, false, draw, throughput, q);
}

/* The probability of going on from a surface. */
static double survival_at(const struct pathtracer *pathtracer, int32_t root)
{
    return rgb_most(scene_root_material(pathtracer->scene, root)->reflectance);
}

/* Whether a path goes on from a surface, and with how much. */
static bool goes_on(const struct pathtracer *pathtracer, int32_t root, struct draw *draw,
                    struct rgb *throughput)
{
    const double *rho = scene_root_material(pathtracer->scene, root)->reflectance.band;
    double survival = survival_at(pathtracer, root);
    if (hash_unit(draw->next++) >= survival)
        return false;
    for (int c = 0; c < BANDS; c++)
        throughput->band[c] *= rho[c] / survival;
    return true;
}

/* The guess at the reflected radiosity where a path arrives. */
static struct rgb guess_at(const struct forest *forest, const struct arrival *q)
{
    double weight[3];
    int32_t patch = leaf_under(forest, q->root, q->x, weight);
    return rgb_sub(forest->radiosity[patch], forest_material(forest, patch)->emission);
}

static struct rgb irradiance(const struct pathtracer *pathtracer, struct arrival p,
                             struct draw *draw)
{
    struct rgb sum = {{0.0, 0.0, 0.0}}, throughput = {{1.0, 1.0, 1.0}};
    for (;;) {
        struct arrival q;
        add_chosen_light(pathtracer, &p, throughput, draw, &sum);
        if (!follow(pathtracer, &p, draw, &throughput, &q))
            return sum;
        add_met_light(pathtracer, &p, &q, throughput, &sum);
        struct rgb before = throughput;
        double survival = survival_at(pathtracer, q.root);
        bool on = goes_on(pathtracer, q.root, draw, &throughput);
        if (pathtracer->guess)
            add_light(&sum, before, on ? 1.0 - 1.0 / survival : 1.0,
                      guess_at(pathtracer->guess, &q));
        if (!on)
            return sum;
        p = q;
    }
}

struct rgb pathtracer_reflected(const struct pathtracer *pathtracer, int32_t root,
                                const struct triangle *part, int samples, uint64_t seed)
{
    struct rgb sum = {{0.0, 0.0, 0.0}};
    struct rgb rho = scene_root_material(pathtracer->scene, root)->reflectance;
    struct triangle t = scene_root_triangle(pathtracer->scene, root);
    struct draw draw = draw_make(seed);
    for (; draw.sample < samples && !stop_is_asked(); draw.sample++) {
        draw.used = 0;
        struct arrival start = {.root = root};
        start.x = corners_mean(t.corner, point_on(part, &draw));
        add_light(&sum, rho, 1.0 / samples, irradiance(pathtracer, start, &draw));
    }
    return sum;
}

void pathtracer_shine(const struct pathtracer *pathtracer, uint64_t seed,
                      void (*land)(void *listener, const struct landing *landing),
                      void *listener)
{
    const struct scene *scene = pathtracer->scene;
    struct draw draw = draw_make(seed);
    struct arrival p = {.root = choose_light(pathtracer, &draw)}, q;
    struct triangle t = scene_root_triangle(scene, p.root);
    p.x = point_on(&t, &draw);
    struct rgb emission = scene_root_material(scene, p.root)->emission;
    struct rgb light = rgb_scale(emission, 1.0 / rgb_sum(emission));
    for (;;) {
        if (!follow(pathtracer, &p, &draw, &light, &q))
            return;
        struct landing landing = {.root = q.root, .light = light};
        t = scene_root_triangle(scene, q.root);
        triangle_weights(&t, q.x, landing.weight);
        land(listener, &landing);
        if (!goes_on(pathtracer, q.root, &draw, &light))
            return;
        p = q;
    }
}

struct rgb pathtracer_seen(const struct pathtracer *pathtracer, pixel_ray *ray,
                           const void *pixel, bool fronts_only, int samples,
                           uint64_t seed)
{
    struct rgb sum = {{0.0, 0.0, 0.0}};
    struct draw draw = draw_make(seed);
    for (draw.sample = 0; draw.sample < samples; draw.sample++) {
        struct arrival seen;
        draw.used = 0;
        double u = draw_next(&draw), v = draw_next(&draw);
        struct half_line eye = ray(pixel, u, v);
        struct rgb throughput = {{1.0, 1.0, 1.0}};
        if (!travel(pathtracer, eye, fronts_only, &draw, &throughput, &seen))
            continue;
        const struct material *material;
        material = scene_root_material(pathtracer->scene, seen.root);
        add_light(&sum, throughput, 1.0 / samples, material->emission);
        throughput = rgb_times(throughput, material->reflectance);
        add_light(&sum, throughput, 1.0 / samples, irradiance(pathtracer, seen, &draw));
    }
    return sum;
}
