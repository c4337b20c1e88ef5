/* Smooth shading.
 *
 * A vertex is a corner of leaves. Leaves on one smooth surface (io/picture/surface.h)
 * have a common vertex where their corners are the same point and nothing stands between
 * them (io/picture/vertices.h). A vertex may lie inside the edge of a leaf larger than
 * its neighbours, too: a T-vertex. The value of a vertex is the mean radiosity of the
 * leaves around it.
 *
 * Means blur: where the light changes fast, as at a lamp, a leaf shows more or less light
 * than its own. So the deficit of each leaf, its radiosity less the shown mean, is added
 * to its vertices, as a mean over the leaves around weighted by area. Light with the
 * shadows of lamps in it gets one such correction, and the value of a vertex stays in the
 * range of the leaves around it, so shadows get no bright rims. The error of pictures
 * falls by a tenth to a third (furnished room, Cornell box).
 *
 * Light without that of lamps is smooth, and falls or rises up to the very edge of a
 * surface, beyond the means of all leaves there: such light gets ROUNDS corrections and
 * BEYOND times this range. More corrections, and leaves with few rays, would exaggerate
 * noise, so each deficit d, of a leaf whose radiosity has the standard deviation s,
 * counts 1 - (s/d)^2 times, or not at all: the estimate of a value from one noisy sample
 * (James and Stein, 1961). The last correction takes deficits whole: else light would be
 * lost, .6 % of the picture of a furnished room (make cycles).
 *
 * Where a box stands on the floor, or a picture hangs close to a wall, leaves are covered
 * in part: their rows tell the open share (rad/beyond/gather/rows.h). The covered part is
 * dark and invisible, and must not darken the rest. The light of the leaf belongs to its
 * open part, if that is a quarter at least: the shown irradiance is the leaf's over the
 * open share. A vertex with only covered leaves around it takes their mean.
 *
 * In the housing of a lamp light is a hundred times as bright as in the room, and rises
 * and falls by much of this over a leaf, in no straight line. Leaves with a variation
 * beyond the mean of all light, one in two hundred by area, had half of the squared error
 * of the pictures of furnished rooms. Such leaves are steep: no value is to be
 * interpolated there, and no reflected light lacks.
 *
 * Between its corners a leaf interpolates linearly. A leaf with T-vertices is divided, as
 * its children would be, into tiles without any; where a corner of a tile is no vertex,
 * in the middle of an edge, the corner shows the mean of the ends. So a T-vertex shows
 * the light around it, and the large leaf takes the light up over a tile as large as its
 * small neighbours. The result is continuous on every smooth surface, but for T-junctions
 * of the input mesh itself. */
#include "io/picture/shading.h"

#include <math.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/picture/surface.h"
#include "io/picture/vertices.h"
#include "rad/beyond/gather/gather.h"
#include "rad/beyond/sample.h"

/* --- tiles of leaves with T-vertices --- */

struct tile {
    int32_t leaf;
    int32_t vertex[3];   /* at the corners, or -1 */
    struct rgb value[3]; /* W/m^2 */
};

static struct tile whole_leaf(const struct shading *shading, const struct rgb *values,
                              int32_t leaf)
{
    struct tile whole = {.leaf = leaf};
    for (int k = 0; k < 3; k++) {
        whole.vertex[k] = shading->corners[3 * (int64_t)leaf + k];
        whole.value[k] = values[whole.vertex[k]];
    }
    return whole;
}

/* Makes the tile between the middles of the edges: corner k is opposite to corner k of
 * the whole. Returns whether a middle is a T-vertex, and so the whole divided. */
static bool find_inner(const struct vertices *vertices, const struct rgb *values,
                       const struct tile *whole, struct tile *inner)
{
    bool divided = false;
    inner->leaf = whole->leaf;
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        int32_t v =
            vertices_between(vertices, whole->vertex[a], whole->vertex[b], whole->leaf);
        for (int c = 0; c < BANDS; c++)
            inner->value[k].band[c] =
                v >= 0 ? values[v].band[c]
                       : 0.5 * (whole->value[a].band[c] + whole->value[b].band[c]);
        inner->vertex[k] = v;
        divided = divided || v >= 0;
    }
    return divided;
}

/* Returns child 0, 1 or 2, as triangle_child(). */
static struct tile outer_tile(const struct tile *whole, const struct tile *inner,
                                int child)
{
    struct tile outer = *whole;
    for (int k = 0; k < 3; k++)
        if (k != child) {
            outer.vertex[k] = inner->vertex[3 - child - k];
            outer.value[k] = inner->value[3 - child - k];
        }
    return outer;
}

/* Adds the mean of a tile times `share`. */
static void add_mean(const struct shading *shading, const struct tile *tile,
                     double share, struct rgb *mean)
{
    struct tile inner, outer;
    if (shading->divided[tile->leaf] &&
        find_inner(shading->vertices, shading->values, tile, &inner)) {
        share *= 0.25;
        for (int k = 0; k < 3; k++) {
            outer = outer_tile(tile, &inner, k);
            add_mean(shading, &outer, share, mean);
        }
        tile = &inner;
    }
    for (int k = 0; k < 3; k++)
        rgb_add(mean, share / 3.0, tile->value[k]);
}

/* --- values --- */

const double DEVIATION = 0.4;

/* Corrections of light without that of lamps; how far this light may be beyond the
 * leaves. */
enum { ROUNDS = 4 };
static const double BEYOND = 1.5;

/* Least open share of an uncovered leaf. */
static const double LEAST_OPEN = 0.25;

/* Weight of a covered leaf, which counts only at vertices without open leaves. */
static const double COVERED = 1e-12;

/* Returns the radiosity of the open part of a leaf, less less[leaf]. The whole irradiance
 * of the leaf falls on its open part. */
static struct rgb open_radiosity(const struct forest *forest, const struct rgb *less,
                                 int32_t leaf, double fraction)
{
    struct rgb b = forest->radiosity[leaf], e = forest_material(forest, leaf)->emission;
    for (int c = 0; c < BANDS && less; c++)
        b.band[c] = fmax(e.band[c], b.band[c] - less[leaf].band[c]);
    for (int c = 0; c < BANDS && fraction > 0.0; c++)
        b.band[c] = e.band[c] + (b.band[c] - e.band[c]) / fraction;
    return b;
}

/* --- all leaves --- */

/* The deficits of the leaves around a vertex. */
struct lack {
    struct rgb sum;         /* of weight times deficit */
    double weight;          /* sum */
    struct rgb least, most; /* values of the open leaves, W/m^2 */
};

struct blend {
    struct shading *shading;
    const struct rgb *less; /* [patches] radiosity to subtract, W/m^2, or NULL */
    const float *error;     /* [patches] of radiosity, W/m^2, or NULL */
    const float *outside;   /* [patches] open share of a leaf, 1; NULL: all are open */
    int32_t *surface;       /* [roots] of surface_of_roots() */
    int round;              /* 0: the means at vertices; then corrections */
    bool is_last;           /* of the corrections: takes deficits whole */
    struct lack *lacks;     /* [vertex_count] */
    struct rgb value, deficit; /* of the leaf at hand, W/m^2 */
    double fraction, weight;   /* open part of the leaf, 1; weight of its deficit */
    double steep;              /* least difference over a steep leaf, over bands, W/m^2 */
};

/* Calls `visit` for each leaf of a sky, or for each of the others. */
static void for_leaves(struct blend *blend, bool sky,
                       void (*visit)(struct blend *blend, int32_t leaf))
{
    const struct forest *forest = blend->shading->forest;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0 && !stop_is_asked(); leaf = forest_next_leaf(forest, leaf))
        if (scene_is_sky(forest->scene, (int32_t)forest->patches[leaf].id.root) == sky)
            visit(blend, leaf);
}

static void for_each_leaf(struct blend *blend,
                          void (*visit)(struct blend *blend, int32_t leaf))
{
    for_leaves(blend, false, visit);
    for_leaves(blend, true, visit);
}

/* The open share of a leaf, 1; 0: counts as covered. */
static double open_share(const struct blend *blend, int32_t leaf)
{
    double share = blend->outside ? (double)blend->outside[leaf] : 1.0;
    return share < LEAST_OPEN ? 0.0 : share;
}

static void add_flat_leaf(struct blend *blend, int32_t leaf)
{
    struct shading *shading = blend->shading;
    const struct forest *forest = shading->forest;
    struct triangle t = forest_triangle(forest, leaf);
    for (int k = 0; k < 3; k++) {
        int32_t v = vertices_append(shading->vertices, t.corner[k],
                                    (int32_t)forest->patches[leaf].id.root);
        shading->corners[3 * (int64_t)leaf + k] = v;
    }
}

static void light_flat_leaf(struct blend *blend, int32_t leaf)
{
    struct shading *shading = blend->shading;
    for (int k = 0; k < 3; k++)
        shading->values[shading->corners[3 * (int64_t)leaf + k]] =
            shading->forest->radiosity[leaf];
}

static void add_leaf(struct blend *blend, int32_t leaf)
{
    const struct forest *forest = blend->shading->forest;
    struct triangle t = forest_triangle(forest, leaf);
    blend->shading->shades[leaf] =
        open_share(blend, leaf) > 0.0 ? SHADE_SMOOTH : SHADE_COVERED;
    for (int k = 0; k < 3; k++)
        blend->shading->corners[3 * (int64_t)leaf + k] =
            vertices_reach(blend->shading->vertices, t.corner[k],
                           blend->surface[forest->patches[leaf].id.root]);
}

static void find_division(struct blend *blend, int32_t leaf)
{
    struct shading *shading = blend->shading;
    const struct rgb *values = shading->values;
    struct tile whole = whole_leaf(shading, values, leaf), inner;
    shading->divided[leaf] = find_inner(shading->vertices, values, &whole, &inner);
}

static bool is_steep(const struct blend *blend, int32_t leaf)
{
    struct tile whole =
        whole_leaf(blend->shading, blend->shading->values, leaf);
    double low = HUGE_VAL, high = 0.0;
    for (int k = 0; k < 3; k++) {
        low = fmin(low, rgb_sum(whole.value[k]));
        high = fmax(high, rgb_sum(whole.value[k]));
    }
    return high - low > blend->steep;
}

/* Returns the deficit of the leaf at hand, less its noise. */
static struct rgb deficit_of(const struct blend *blend, int32_t leaf)
{
    struct tile whole =
        whole_leaf(blend->shading, blend->shading->values, leaf);
    struct rgb mean = {{0.0, 0.0, 0.0}};
    double largest = 0.0, share = 1.0, fraction = blend->fraction;
    add_mean(blend->shading, &whole, 1.0, &mean);
    struct rgb deficit = rgb_sub(blend->value, mean);
    for (int c = 0; c < BANDS; c++)
        largest = fmax(largest, fabs(deficit.band[c]));
    if (blend->less && blend->error && blend->round > 0 && !blend->is_last &&
        fraction > 0.0 && largest > 0.0) {
        double part = DEVIATION * (double)blend->error[leaf] / (fraction * largest);
        share = fmax(0.0, 1.0 - part * part);
    }
    for (int c = 0; c < BANDS; c++)
        deficit.band[c] *= share;
    return deficit;
}

/* Gives the deficit of the leaf at hand to a vertex. */
static void give(struct blend *blend, int32_t vertex)
{
    struct lack *lack = &blend->lacks[vertex];
    double weight = blend->weight;
    lack->weight += weight;
    for (int c = 0; c < BANDS; c++) {
        double value = blend->value.band[c];
        lack->sum.band[c] += weight * blend->deficit.band[c];
        if (blend->fraction > 0.0) {
            lack->least.band[c] = fmin(lack->least.band[c], value);
            lack->most.band[c] = fmax(lack->most.band[c], value);
        }
    }
}

/* Gives the value to the T-vertices in the edge from u to v. Recurses down to an edge
 * without, at most ID_MAX_LEVEL halvings. */
static void give_inside(struct blend *blend, int32_t leaf, int32_t u, int32_t v)
{
    int32_t middle = vertices_between(blend->shading->vertices, u, v, leaf);
    if (middle < 0)
        return;
    give(blend, middle);
    give_inside(blend, leaf, u, middle);
    give_inside(blend, leaf, middle, v);
}

static void give_leaf(struct blend *blend, int32_t leaf)
{
    const struct forest *forest = blend->shading->forest;
    const int32_t *corner = &blend->shading->corners[3 * (int64_t)leaf];
    double fraction = open_share(blend, leaf);
    double area = blend->round > 0 ? forest_area(forest, leaf) : 1.0;
    if (blend->less && blend->round > 0 && is_steep(blend, leaf))
        return;
    blend->fraction = fraction;
    blend->value = open_radiosity(forest, blend->less, leaf, fraction);
    blend->weight = fmax(fraction, COVERED) * area;
    blend->deficit = deficit_of(blend, leaf);
    for (int k = 0; k < 3; k++)
        give(blend, corner[k]);
    for (int k = 0; k < 3 && blend->shading->divided[leaf]; k++)
        give_inside(blend, leaf, corner[k], corner[(k + 1) % 3]);
}

/* Adds the mean deficit of the leaves around to each vertex. In corrections a vertex with
 * only covered or steep leaves around it keeps its value. */
static void give_what_lacks(struct blend *blend)
{
    struct shading *shading = blend->shading;
    blend->lacks = alloc_array((size_t)shading->vertex_count, sizeof *blend->lacks);
    for (int64_t v = 0; v < shading->vertex_count; v++)
        for (int c = 0; c < BANDS; c++) {
            blend->lacks[v].least.band[c] = HUGE_VAL;
            blend->lacks[v].most.band[c] = -HUGE_VAL;
        }
    for_each_leaf(blend, give_leaf);
    for (int64_t v = 0; v < shading->vertex_count; v++) {
        const struct lack *lack = &blend->lacks[v];
        bool open = lack->least.band[0] <= lack->most.band[0];
        double beyond = blend->less ? BEYOND : 1.0;
        for (int c = 0; c < BANDS && (open || blend->round == 0); c++) {
            double *value = &shading->values[v].band[c];
            double low = open ? lack->least.band[c] / beyond : 0.0;
            double high = open ? lack->most.band[c] * beyond : HUGE_VAL;
            *value += lack->sum.band[c] / lack->weight;
            *value = fmin(high, fmax(low, *value));
        }
    }
    alloc_free(blend->lacks);
}

static void find_steep(struct blend *blend, int32_t leaf)
{
    if (is_steep(blend, leaf))
        blend->shading->shades[leaf] = SHADE_STEEP;
}

/* Finds the values at vertices: of all light, or of light less less[leaf]. */
static void blend_light(struct blend *blend, const struct rgb *less)
{
    int rounds = less ? ROUNDS : 1;
    blend->less = less;
    for (blend->round = 0; blend->round <= rounds; blend->round++) {
        blend->is_last = blend->round == rounds;
        give_what_lacks(blend);
    }
}

/* Makes the vertices; those of a sky come last. `octree`: NULL: `add` shares none. */
static void make_vertices(struct blend *blend, const struct octree *octree,
                          void (*add)(struct blend *blend, int32_t leaf))
{
    struct shading *shading = blend->shading;
    for_leaves(blend, false, add);
    if (octree)
        vertices_part(shading->vertices, shading->forest, octree, shading->corners);
    shading->own_count = shading->vertices->count;
    for_leaves(blend, true, add);
    shading->positions = shading->vertices->positions;
    shading->vertex_count = shading->vertices->count;
    shading->values = alloc_array((size_t)shading->vertex_count, sizeof *shading->values);
}

/* The light of lamps is all light less the light without that of lamps. */
static void blend_leaves(struct blend *blend, const struct octree *octree,
                         const struct rgb *less)
{
    struct shading *shading = blend->shading;
    blend->steep = forest_mean_reflected(shading->forest);
    blend->surface = surface_of_roots(shading->forest->scene);
    make_vertices(blend, octree, add_leaf);
    for_each_leaf(blend, find_division);
    blend_light(blend, NULL);
    if (less) {
        size_t count = (size_t)shading->vertex_count;
        shading->lamps = shading->values;
        shading->values = alloc_array(count, sizeof *shading->values);
        blend_light(blend, less);
    }
    for (int64_t v = 0; v < shading->vertex_count && less; v++)
        shading->lamps[v] = rgb_sub(shading->lamps[v], shading->values[v]);
    alloc_free(blend->surface);
    for_each_leaf(blend, find_steep);
}

static struct shading *allocate(const struct forest *forest)
{
    struct shading *shading = alloc_array(1, sizeof *shading);
    size_t patches = (size_t)forest->count;
    shading->forest = forest;
    shading->corners = alloc_array(3 * patches, sizeof *shading->corners);
    shading->divided = alloc_array(patches, sizeof *shading->divided);
    shading->shades = alloc_array(patches, sizeof *shading->shades);
    shading->vertices = alloc_array(1, sizeof *shading->vertices);
    return shading;
}

struct shading *shading_create(const struct forest *forest, const struct octree *octree,
                               const struct rgb *less, const float *error,
                               const float *outside)
{
    struct blend blend = {.shading = allocate(forest), .error = error,
                          .outside = outside};
    blend_leaves(&blend, octree, less);
    return blend.shading;
}

struct shading *shading_create_flat(const struct forest *forest)
{
    struct blend blend = {.shading = allocate(forest)};
    blend.shading->flat = true;
    make_vertices(&blend, NULL, add_flat_leaf);
    for_each_leaf(&blend, light_flat_leaf);
    return blend.shading;
}

void shading_destroy(struct shading *shading)
{
    if (!shading)
        return;
    vertices_free(shading->vertices);
    alloc_free(shading->vertices);
    alloc_free(shading->values);
    alloc_free(shading->lamps);
    alloc_free(shading->divided);
    alloc_free(shading->shades);
    alloc_free(shading->corners);
    alloc_free(shading);
}

struct rgb shading_at(const struct shading *shading, const struct rgb *values,
                      int32_t root, const double weight[3])
{
    double w[3] = {weight[0], weight[1], weight[2]};
    int32_t p = leaf_at(shading->forest, root, w);
    if (shading->flat)
        return values[shading->corners[3 * (int64_t)p]];
    struct tile tile = whole_leaf(shading, values, p), inner;
    for (int child = 0; child < 3 && shading->divided[p] &&
                        find_inner(shading->vertices, values, &tile, &inner);) {
        child = triangle_child_at(w);
        tile = child < 3 ? outer_tile(&tile, &inner, child) : inner;
    }
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < 3; k++)
        rgb_add(&sum, w[k], tile.value[k]);
    return sum;
}
