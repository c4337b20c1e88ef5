/* Surfaces in the dark, and lit ones.
 *
 * Where a room is dark beside a lit one, its leaves look for light as others do not
 * (gather_narrow.c, gather_sparks.c). What is dark or lit is often not a whole root: a
 * floor that goes on below a door is one face. So a root is a region, but where it is not
 * in the dark and a large part of it is, its children are, and so on.
 *
 * A leaf at the border, which reaches below the wall into the light, would show its mean
 * to the dark room, a hundred times the light there; all of them together made a room
 * twice as bright. So leaves at a border are split, until they are too small to reach
 * through a wall. */
#include "rad/beyond/gather_regions.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/final_gather.h"
#include "rad/beyond/met.h"
#include "rad/beyond/sample.h"

/* A region is large that has this part of all area. */
static const double LARGE = 1e-3;

/* A leaf is at a border if one of its quarters has this many times the light of another,
 * at least this part of the mean (less comes into sealed rooms, by rounding), and the
 * leaf this part of all area. */
static const double MIXED = 10.0, LEAST_LIT = 1e-6, LEAST_AT_BORDER = 2e-6;

/* Points of a region that have room before them, or not: a distance whose square is more
 * than this part of the area. */
enum { POINTS = 8 };
static const double WIDE = 0.04;

/* Rays that tell how much of a point's light goes into the dark. */
enum { DARK_RAYS = 32 };

double patch_irradiance(const struct forest *forest, int32_t patch)
{
    struct rgb rho = forest_material(forest, patch)->reflectance;
    return BANDS * patch_reflected(forest, patch) / rgb_sum(rho);
}

double patch_reflected(const struct forest *forest, int32_t patch)
{
    return rgb_sum(forest->radiosity[patch]) -
           rgb_sum(forest_material(forest, patch)->emission);
}

bool patch_is_dark(const struct final_gather *g, int32_t patch)
{
    double h = patch_irradiance(g->model->forest, patch); /* NaN if it is black */
    return DARK_TIMES * h < g->mean;
}

/* True if it is known, and not dark. */
static bool patch_is_lit(const struct final_gather *g, int32_t patch)
{
    return DARK_TIMES * patch_irradiance(g->model->forest, patch) >= g->mean;
}

/* The distance from a point of a surface up to the next one, scene units; 0 if that shows
 * its back: then the point is inside of a thing. */
static double room_before(struct final_gather *g, struct vec3 x, struct vec3 up)
{
    const struct scene *scene = g->model->scene;
    struct octree_hit hit;
    if (!octree_first_hit(g->model->octree, point_above(x, up), up, false, &hit,
                          &g->view.counts))
        return HUGE_VAL;
    int32_t root = scene_root_on(scene, hit.triangle, hit.front);
    struct plane plane = scene_root_plane(scene, root < 0 ? 0 : root);
    double fall = -vec3_dot(plane.normal, up); /* above 0: a front is met */
    return root >= 0 && fall > 0.0 ? plane_distance(&plane, x) / fall : 0.0;
}

double share_in_the_dark(struct final_gather *g, int32_t region, struct vec3 x,
                         uint64_t seed)
{
    struct receiver r = {.gather = g, .facet = facet_make(g->model->forest, region)};
    struct vec3 normal = r.facet.plane.normal, along = direction_along(normal);
    int dark = 0, lit = 0;
    for (uint64_t i = 0; i < DARK_RAYS; i++) {
        struct point point;
        struct vec3 direction = cosine_direction(
            normal, along, ((double)i + hash_unit(seed)) / DARK_RAYS,
            hash_unit(seed + 16 + i));
        if (trace(&r, point_above(x, normal), direction, &point) != MET_FRONT)
            continue;
        dark += patch_is_dark(g, point.patch);
        lit += patch_is_lit(g, point.patch);
    }
    return dark > 0 ? (double)dark / (dark + lit) : 0.0;
}

/* True if there is room before most of the region: else a thing stands on it, or it is in
 * a gap that is narrow for it. And most that it sees is dark: else rays find the light,
 * as from a face that looks out of the scene. */
static bool is_in_a_dark_room(struct final_gather *g, int32_t region)
{
    struct facet facet = facet_make(g->model->forest, region);
    struct sequence sequence =
        sequence_start(hash_mix(patch_seed(g->model->forest, region) + 65));
    struct apart apart = apart_begin(g); /* each rank does the same */
    double u[SEQUENCE_DIMENSIONS], dark = 0.0;
    int roomy = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        sequence_point(&sequence, i, u);
        struct vec3 x = triangle_of_square(&facet.triangle, u[0], u[1]);
        double room = room_before(g, x, facet.plane.normal);
        roomy += room * room > WIDE * facet.area;
        dark += share_in_the_dark(g, region, x, hash_mix(sequence.scramble[0] + i));
    }
    apart_end(g, &apart);
    return 2 * roomy > POINTS && 4.0 * dark > 3.0 * POINTS;
}

static bool is_dark_room(struct final_gather *g, int32_t region)
{
    return forest_area(g->model->forest, region) >= LARGE * g->model->area &&
           patch_is_dark(g, region) && is_in_a_dark_room(g, region);
}

bool final_gather_is_at_border(struct final_gather *g, int32_t leaf,
                               const struct gather_look *look)
{
    const struct forest *forest = g->model->forest;
    double rho = rgb_sum(forest_material(forest, leaf)->reflectance);
    double light[4] = {0.0, 0.0, 0.0, 0.0}; /* H of each quarter, over bands */
    int least = 0, most = 0;
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < BANDS; c++)
            light[k] += BANDS * (double)look->reflected[k][c] / rho;
        least = light[k] < light[least] ? k : least;
        most = light[k] > light[most] ? k : most;
    }
    if (!(DARK_TIMES * light[least] < g->mean &&
          light[most] > fmax(MIXED * light[least], LEAST_LIT * g->mean)) ||
        forest_area(forest, leaf) < LEAST_AT_BORDER * g->model->area)
        return false;
    struct facet facet = facet_make(forest, leaf);
    struct triangle quarter = triangle_child(&facet.triangle, least);
    struct vec3 x = triangle_centroid(&quarter);
    struct apart apart = apart_begin(g); /* each rank does the same */
    double room = room_before(g, x, facet.plane.normal);
    bool dark = room * room > LARGE * g->model->area &&
                4.0 * share_in_the_dark(g, leaf, x, patch_seed(forest, leaf) + 66) > 3.0;
    apart_end(g, &apart);
    return dark;
}

/* The area of leaves in the dark. */
static double dark_area(const struct final_gather *g, int32_t patch)
{
    const struct patch *at = &g->model->forest->patches[patch];
    double area = 0.0;
    if (patch_is_leaf(at))
        return patch_is_dark(g, patch) ? forest_area(g->model->forest, patch) : 0.0;
    for (int k = 0; k < 4; k++)
        area += dark_area(g, at->children + k);
    return area;
}

bool patch_has_dark(const struct final_gather *g, int32_t patch)
{
    return dark_area(g, patch) > 0.0;
}

static void name_leaves(struct regions *regions, const struct forest *forest,
                        int32_t patch, int32_t region)
{
    const struct patch *at = &forest->patches[patch];
    regions->of[patch] = region;
    for (int k = 0; k < 4 && !patch_is_leaf(at); k++)
        name_leaves(regions, forest, at->children + k, region);
}

static void add_regions(struct regions *regions, struct final_gather *g, int32_t patch)
{
    const struct forest *forest = g->model->forest;
    const struct patch *at = &forest->patches[patch];
    bool mixed = !patch_is_leaf(at) && !patch_is_dark(g, patch) &&
                 dark_area(g, patch) >= LARGE * g->model->area;
    for (int k = 0; k < 4 && mixed; k++)
        add_regions(regions, g, at->children + k);
    if (mixed)
        return;
    RESERVE(regions->items, &regions->capacity, regions->count + 1);
    regions->items[regions->count++] = patch;
    name_leaves(regions, forest, patch, patch);
    regions->dark[patch] = is_dark_room(g, patch);
}

const struct regions *gather_regions(struct final_gather *g)
{
    const struct forest *forest = g->model->forest;
    struct regions *regions = g->view.regions;
    if (regions)
        return regions;
    regions = g->view.regions = alloc_array(1, sizeof *regions);
    regions->of = alloc_array((size_t)forest->count, sizeof *regions->of);
    regions->dark = alloc_array((size_t)forest->count, 1);
    for (int32_t root = 0; root < forest->root_count; root++)
        add_regions(regions, g, root);
    return regions;
}

bool region_is_dark(struct final_gather *g, int32_t region)
{
    return gather_regions(g)->dark[region];
}

int32_t region_of(struct final_gather *g, int32_t leaf)
{
    return gather_regions(g)->of[leaf];
}

struct apart apart_begin(const struct final_gather *g)
{
    return (struct apart){g->model->counts, g->counts, g->model->estimating};
}

void apart_end(struct final_gather *g, const struct apart *apart)
{
    const struct octree_counts *tests = &g->model->counts;
    g->view.counts.node_tests += tests->node_tests - apart->tests.node_tests;
    g->view.counts.triangle_tests += tests->triangle_tests - apart->tests.triangle_tests;
    g->model->counts = apart->tests;
    g->model->estimating = apart->estimating;
    g->counts = apart->rays;
}

void regions_free(struct regions *regions)
{
    if (!regions)
        return;
    alloc_free(regions->items);
    alloc_free(regions->of);
    alloc_free(regions->dark);
    alloc_free(regions);
}
