/* Contact shadows.
 *
 * At the foot of a block in the shade light falls off towards the floor, within a leaf,
 * of which the mesh has the mean: the block seems to float. Where a leaf touches a
 * surface, half of the directions at the line of contact end there: so light changes over
 * the leaf if the surface sends less than arrives on the leaf. Such a leaf, when it is
 * first seen, is divided into tiles, and its reflected light is found at their corners,
 * as at the points of covered leaves, and interpolated. Rays have the same directions at
 * all corners: their noise is the same, and makes no pattern. */
#include "io/picture/contact.h"

#include <math.h>

#include "geom/alloc.h"
#include "rad/beyond/sample.h"

/* A surface is dark if it sends less than this part of the light on the leaf, 1. */
static const double DARK = 0.8;

/* A surface on the way from the middle of a leaf to its edge ends the leaf after this
 * part of the way; before, it stands on the leaf. */
static const double ENDS = 0.97;

/* Tiles along an edge of a leaf, and their corners. */
enum { TILES = 2, CORNERS = (TILES + 1) * (TILES + 2) / 2 };

/* Rays from a corner are those from a leaf over FEWER; segments to lamps from a point
 * met. */
enum { FEWER = 2, SEGMENTS = 8 };

/* A leaf, and the means to find its light. */
struct parcel {
    const struct shading *shading;
    struct final_gather *gather;
    int32_t leaf;
    struct triangle triangle;
    struct plane plane;
    struct vec3 middle;
};

/* Finds the surface met first on the way from the leaf's middle to a point x of it, and a
 * little farther, rising a little; `share`: of the way to x. */
static bool is_met(const struct parcel *parcel, struct vec3 x, struct octree_hit *hit,
                   double *share)
{
    static const double FARTHER = 1.1, RISE = 0.02;
    struct model *model = parcel->gather->model;
    struct vec3 way = vec3_sub(x, parcel->middle);
    double length = vec3_length(way);
    struct vec3 normal = parcel->plane.normal, from = point_above(parcel->middle, normal);
    struct vec3 direction = vec3_add(way, vec3_scale(normal, RISE * length));
    if (!(length > 0.0) ||
        !octree_first_hit(model->octree, from, vec3_unit(direction), false, hit,
                          &model->counts))
        return false;
    octree_hit_weights(model->octree, from, vec3_unit(direction), hit);
    const struct plane *plane = &model->scene->planes[hit->triangle];
    double fall = vec3_dot(plane->normal, direction);
    *share = -plane_distance(plane, from) / fall;
    return *share >= 0.0 && *share <= FARTHER;
}

static int32_t root_of(const struct forest *forest, int32_t patch)
{
    return (int32_t)forest->patches[patch].id.root;
}

/* True if the point of a root met sends less than `most`, over bands, W/m^2. Light of
 * lamps is found by segments, since the leaf there may reach far out of the shade. */
static bool sends_less(const struct parcel *parcel, int32_t root,
                       const struct octree_hit *hit, double most)
{
    const struct shading *shading = parcel->shading;
    const struct scene *scene = shading->forest->scene;
    const struct material *m = scene_root_material(scene, root);
    double w[3] = {hit->weight[0], hit->weight[hit->front ? 1 : 2],
                   hit->weight[hit->front ? 2 : 1]};
    struct rgb sent = shading_at(shading, shading->values, root, w);
    if (rgb_sum(sent) >= most)
        return false;
    struct triangle triangle = scene_root_triangle(scene, root);
    struct vec3 x = corners_mean(triangle.corner, (struct vec3){w[0], w[1], w[2]});
    struct gather_points points = {.at = &x, .count = 1, .middle = x, .root = root,
                                   .plane = scene_root_plane(scene, root)};
    struct gather_light light =
        final_gather_at(parcel->gather, &points, 1, SEGMENTS, 0);
    for (int c = 0; c < BANDS; c++)
        sent.band[c] += m->reflectance.band[c] * light.lamps.band[c];
    return rgb_sum(sent) < most;
}

/* True if a dark surface ends the leaf on one of six ways from its middle, and nothing
 * stands on it: inside of things there is no light to be found. */
static bool touches_dark(const struct parcel *parcel)
{
    const struct forest *forest = parcel->shading->forest;
    const struct material *m = forest_material(forest, parcel->leaf);
    int32_t own = root_of(forest, parcel->leaf);
    struct triangle triangle = scene_root_triangle(forest->scene, own);
    const struct vec3 *corner = parcel->triangle.corner;
    double weight[3], arrives = 0.0, share;
    triangle_weights(&triangle, parcel->middle, weight);
    struct rgb rest = shading_at(parcel->shading, parcel->shading->values, own, weight);
    for (int c = 0; c < BANDS; c++)
        if (m->reflectance.band[c] > 0.0)
            arrives += (rest.band[c] - m->emission.band[c]) / m->reflectance.band[c];
    bool dark = false;
    for (int k = 0; k < 6; k++) { /* beside a corner two faces may meet: not to it */
        struct octree_hit hit;
        double part = k < 3 ? 0.0625 : 0.5;
        struct vec3 a = corner[k % 3], along = vec3_sub(corner[(k + 1) % 3], a);
        struct vec3 x = vec3_add(a, vec3_scale(along, part));
        if (!is_met(parcel, x, &hit, &share))
            continue;
        if (share < ENDS)
            return false;
        int32_t root = scene_root_on(forest->scene, hit.triangle, hit.front);
        dark = dark || (root >= 0 && sends_less(parcel, root, &hit, DARK * arrives));
    }
    return dark;
}

/* Returns the radiosity at the point x of the leaf by all but the light of lamps. */
static struct rgb find_rest(const struct parcel *parcel, struct vec3 x)
{
    static const double BEFORE = 0.97;
    const struct material *m = forest_material(parcel->shading->forest, parcel->leaf);
    int rays = (parcel->gather->model->criterion.final_gather + FEWER - 1) / FEWER;
    x = vec3_add(parcel->middle, vec3_scale(vec3_sub(x, parcel->middle), BEFORE));
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = parcel->plane,
                                   .root = root_of(parcel->shading->forest,
                                                   parcel->leaf)};
    struct gather_light light = final_gather_at(parcel->gather, &points, 1, 1, rays);
    struct rgb rest = m->emission;
    for (int c = 0; c < BANDS; c++)
        rest.band[c] += m->reflectance.band[c] * light.rest.band[c];
    return rest;
}

/* Corner i, j of the tiles: i steps from corner 0 of the leaf to 1, j to 2. */
static int corner_number(int i, int j)
{
    return j * (TILES + 1) - j * (j - 1) / 2 + i;
}

/* Finds whether a leaf has a contact, and its tiles, half way to the mean light of the
 * mesh, in factors: both have noise, that of the tiles common to all. */
static void see(struct final_gather *gather, const struct shading *shading, int32_t leaf)
{
    static const double MOST = 2.0; /* factor on the light of the tiles */
    const struct forest *forest = shading->forest;
    struct triangle triangle = forest_triangle(forest, leaf);
    int32_t root = root_of(forest, leaf);
    struct parcel parcel = {shading, gather, leaf, triangle,
                        scene_root_plane(forest->scene, root),
                        triangle_centroid(&triangle)};
    shading->seen[leaf] = true;
    if (!touches_dark(&parcel))
        return;
    struct rgb *tiles = alloc_array(CORNERS, sizeof *tiles);
    struct rgb found = {{0.0, 0.0, 0.0}}, mesh = found;
    struct triangle whole = scene_root_triangle(forest->scene, root);
    for (int j = 0; j <= TILES; j++)
        for (int i = 0; i + j <= TILES; i++) {
            int k = TILES - i - j, ends = (i == 0) + (j == 0) + (k == 0);
            double around = ends == 2 ? 1.0 : ends == 1 ? 3.0 : 6.0; /* tiles */
            struct vec3 weight = {(double)k / TILES, (double)i / TILES,
                                  (double)j / TILES};
            struct vec3 x = corners_mean(triangle.corner, weight);
            double at[3];
            tiles[corner_number(i, j)] = find_rest(&parcel, x);
            triangle_weights(&whole, x, at);
            rgb_add(&found, around, tiles[corner_number(i, j)]);
            rgb_add(&mesh, around, shading_at(shading, shading->values, root, at));
        }
    for (int c = 0; c < BANDS; c++) {
        double factor = found.band[c] > 0.0 ? mesh.band[c] / found.band[c] : 1.0;
        factor = sqrt(real_max(1.0 / MOST, real_min(MOST, factor)));
        for (int k = 0; k < CORNERS; k++)
            tiles[k].band[c] *= factor;
    }
    shading->tiles[leaf] = tiles;
}

bool contact_at(struct final_gather *gather, const struct shading *shading, int32_t leaf,
                const double weight[3], struct rgb *rest)
{
    if (!shading->seen[leaf])
        see(gather, shading, leaf);
    const struct rgb *tiles = shading->tiles[leaf];
    if (!tiles)
        return false;
    double u = real_max(0.0, weight[1]) * TILES, v = real_max(0.0, weight[2]) * TILES;
    int i = u < TILES ? (int)u : TILES - 1, j = v < TILES ? (int)v : TILES - 1;
    if (i + j > TILES - 1)
        i = TILES - 1 - j;
    u -= i;
    v -= j;
    bool upper = u + v > 1.0 && i + j < TILES - 1;
    int a = upper ? corner_number(i + 1, j + 1) : corner_number(i, j);
    int b = corner_number(i + 1, j), c = corner_number(i, j + 1);
    double wb = upper ? 1.0 - v : u, wc = upper ? 1.0 - u : v;
    *rest = (struct rgb){{0.0, 0.0, 0.0}};
    rgb_add(rest, 1.0 - wb - wc, tiles[a]);
    rgb_add(rest, wb, tiles[b]);
    rgb_add(rest, wc, tiles[c]);
    return true;
}
