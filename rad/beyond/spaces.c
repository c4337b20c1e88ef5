/* Finding spaces.
 *
 * A few rays from each root connect it to others. Roots so connected are a part of the
 * scene. Half of those from a pane leave its other side, and so connect the spaces that
 * it parts. Rays prove nothing: a space may have a gap that none has found. So a space
 * says how fine its light is to be. It does not say that no other light gets in. */
#include "rad/beyond/spaces.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"
#include "rad/beyond/sample.h"

/* The part that counts of light spread evenly over a scene. In ordinary rooms it is less
 * than the emitted light, in white ones many times as much. */
static const double LASTING = 0.1;

/* Rays from a root at least, and from all roots, which take some milliseconds. */
enum { ROOT_RAYS = 4, ALL_RAYS = 8192 };

/* A space with less than this part of all light has no number: its light would have few
 * digits in the integers of all. */
static const double FAINT = 0x1p-40;

/* --- light --- */

/* Sums over the roots of a space. */
struct root_sums {
    struct rgb emitted;   /* W, areas in square scene units */
    struct rgb absorbing; /* area times 1 - rho, square scene units */
    double power;         /* emitted, over all bands; of a sky what enters, W */
    double area;          /* without a sky, square scene units */
};

static void add_root(struct root_sums *sums, const struct scene *scene, int32_t root)
{
    const struct material *material = scene_root_material(scene, root);
    double area = scene_root_area(scene, root);
    for (int c = 0; c < BANDS; c++) {
        sums->emitted.band[c] += area * material->emission.band[c];
        sums->absorbing.band[c] += area * (1.0 - material->reflectance.band[c]);
    }
    sums->power += area * rgb_sum(material->emission);
    sums->area += scene_root_own_area(scene, root);
}

/* Evenly spread light has the radiosity E / (1 - rho), by the means of E and rho. */
static double light_of(const struct root_sums *sums)
{
    struct rgb typical;
    for (int c = 0; c < BANDS; c++)
        typical.band[c] = sums->emitted.band[c] / sums->absorbing.band[c];
    return fmax(sums->power, LASTING * (sums->area * rgb_sum(typical)));
}

double scene_light(const struct scene *scene)
{
    struct root_sums all = {.power = 0.0};
    for (int32_t root = 0; root < scene_root_count(scene); root++)
        add_root(&all, scene, root);
    all.power = scene_entering_power(scene);
    return light_of(&all);
}

/* --- parts --- */

static int32_t part_of(int32_t *up, int32_t root)
{
    while (up[root] != root) {
        up[root] = up[up[root]];
        root = up[root];
    }
    return root;
}

/* A part with too few roots to enclose a space is taken to be outside. Its light counts
 * nowhere, as that of the top of a lamp below a ceiling. */
static void join_small_parts(struct spaces *spaces, int32_t all)
{
    enum { TETRAHEDRON = 4 };
    int32_t *part = spaces->part;
    int32_t *roots = alloc_array((size_t)all + 1, sizeof *roots);
    for (int32_t root = 0; root < all; root++)
        roots[part[root]]++;
    for (int32_t root = 0; root < all; root++)
        if (roots[part[root]] < TETRAHEDRON && part[root] != part[all]) {
            part[root] = part[all];
            spaces->of[root] = -1;
        }
    alloc_free(roots);
}

int space_rays(const struct scene *scene)
{
    int each = ALL_RAYS / scene_root_count(scene);
    return each > ROOT_RAYS ? each : ROOT_RAYS;
}

int32_t *places_met(const struct scene *scene, const struct octree *octree,
                    int32_t first, int32_t end)
{
    int32_t all = scene_root_count(scene);
    int rays = space_rays(scene);
    int32_t *met = alloc_array((size_t)rays * (size_t)(end - first), sizeof *met);
    int32_t *at = met;
    struct octree_counts counts = {0};
    for (int32_t root = first; root < end && !stop_is_asked(); root++) {
        struct triangle t = scene_root_triangle(scene, root);
        for (int i = 0; i < rays; i++, at++) {
            *at = -1;
            if (!(scene_root_area(scene, root) > 0.0))
                continue;
            uint64_t seed = hash_mix((uint64_t)root) + 8 * (uint64_t)i;
            bool behind = material_is_pane(scene_root_material(scene, root)) && i % 2;
            struct vec3 normal = vec3_scale(scene_root_plane(scene, root).normal,
                                            behind ? -1.0 : 1.0);
            struct half_line ray = ray_sample(&t, normal, seed, i, rays);
            *at = root_met(scene, octree, &ray, all, &counts);
        }
    }
    return met;
}

static int32_t *find_parts(const struct scene *scene, const int32_t *met)
{
    int32_t all = scene_root_count(scene);
    int rays = space_rays(scene);
    int32_t *up = alloc_array((size_t)all + 1, sizeof *up);
    for (int32_t root = 0; root <= all; root++)
        up[root] = met ? root : 0;
    for (int32_t root = 0; root < all && met; root++)
        for (int i = 0; i < rays; i++, met++)
            if (*met >= 0)
                up[part_of(up, root)] = part_of(up, *met);
    for (int32_t root = 0; root <= all; root++)
        up[root] = part_of(up, root);
    return up;
}

/* --- the whole --- */

/* [roots + 1] the light of each part, W, by its number. */
static double *find_light(const struct scene *scene, const struct spaces *spaces)
{
    const int32_t *part = spaces->part;
    int32_t all = scene_root_count(scene);
    struct root_sums *sums = alloc_array((size_t)all + 1, sizeof *sums);
    double *light = alloc_array((size_t)all + 1, sizeof *light);
    double entering = scene_entering_power(scene) - scene_emitted_power(scene);
    for (int32_t root = 0; root < all; root++)
        if (spaces->of[root] >= 0)
            add_root(&sums[part[root]], scene, root);
    sums[part[all]].power += entering;
    for (int32_t p = 0; p <= all; p++)
        if (rgb_sum(sums[p].emitted) > 0.0)
            light[p] = light_of(&sums[p]);
    alloc_free(sums);
    return light;
}

/* Gives the parts with a lamp numbers, the brightest one 0. */
static void number_parts(struct spaces *spaces, const struct scene *scene)
{
    int32_t all = scene_root_count(scene), brightest = 0;
    double *light = find_light(scene, spaces), whole = scene_light(scene);
    int32_t *number = alloc_array((size_t)all + 1, sizeof *number);
    for (int32_t p = 1; p <= all; p++)
        if (light[p] > light[brightest])
            brightest = p;
    spaces->light[0] = 1.0;
    for (int32_t p = 0; p <= all; p++)
        if (p != brightest && light[p] > FAINT * whole) {
            number[p] = spaces->count;
            spaces->light[spaces->count++] = light[p] / whole;
        }
    if (spaces->count > 1)
        spaces->light[0] = light[brightest] / whole;
    for (int32_t root = 0; root < all; root++) {
        int32_t part = spaces->part[root];
        bool joined = spaces->of[root] < 0;
        spaces->of[root] = joined ? 0 : number[part];
        if (spaces->of[root] > 0 || (part == brightest && !joined) || spaces->count == 1)
            spaces->area[spaces->of[root]] += scene_root_own_area(scene, root);
    }
    alloc_free(number);
    alloc_free(light);
}

struct spaces *spaces_create(const struct scene *scene, const int32_t *met)
{
    struct spaces *spaces = alloc_array(1, sizeof *spaces);
    size_t all = (size_t)scene_root_count(scene);
    spaces->count = 1;
    spaces->part = find_parts(scene, met);
    spaces->of = alloc_array(all, sizeof *spaces->of);
    spaces->light = alloc_array(all + 1, sizeof *spaces->light);
    spaces->area = alloc_array(all + 1, sizeof *spaces->area);
    join_small_parts(spaces, (int32_t)all);
    number_parts(spaces, scene);
    return spaces;
}

void spaces_destroy(struct spaces *spaces)
{
    if (!spaces)
        return;
    alloc_free(spaces->part);
    alloc_free(spaces->of);
    alloc_free(spaces->light);
    alloc_free(spaces->area);
    alloc_free(spaces);
}
