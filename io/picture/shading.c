/* Smooth shading.
 *
 * A vertex is a corner of leaves. Leaves on one smooth surface (io/picture/surface.h)
 * have a common vertex where their corners are the same point. The value of a vertex is
 * the mean radiosity of the leaves around it.
 *
 * Means blur: where the light changes fast, as at a lamp, a leaf shows more or less light
 * than it has. So the deficit of each leaf, its radiosity less the mean of its corners,
 * is added to its corners, as a mean over the leaves around weighted by area. Light with
 * the shadows of lamps in it gets one such correction, and the value of a vertex stays in
 * the range of the leaves around it, so that shadows get no bright rims. The error of
 * pictures falls by a tenth to a third (furnished room, Cornell box).
 *
 * Light without that of lamps is smooth, and falls or rises up to the very edge of a
 * surface, beyond the means of all leaves there: it gets ROUNDS corrections and no such
 * range. More of them, and leaves that have few rays, would exaggerate differences that
 * are noise, so each deficit d, of a leaf whose radiosity has the standard deviation s,
 * counts 1 - (s/d)^2 times, or not at all: the estimate of a value from one noisy sample
 * (James and Stein, 1961). Leaves that have too much by noise have a larger s than those
 * that have too little, so light would be lost: .6 % of the picture of a furnished room
 * (make cycles). The last correction takes deficits whole: as much light is shown as
 * leaves have.
 *
 * Where a box stands on the floor, leaves are covered in part. The covered part is dark
 * and invisible, and must not darken the rest. It is found with the four points where the
 * rays of the leaf's links begin: a point is covered if four rays from it, up and far
 * aside, all meet a back first: it lies inside a solid, not merely below a shelf; or in a
 * gap that is narrow for the leaf, as behind a picture on a wall. If one of the four is
 * covered, sixteen are examined: beside a row of books a strip of the bookcase is open.
 * The light of the leaf then belongs to its open part, if that is a quarter at least: the
 * shown irradiance is that of the leaf over the fraction that is open. A vertex with only
 * covered leaves around it takes their mean.
 *
 * Between its vertices a leaf interpolates linearly. At a T-vertex, a vertex of a fine
 * leaf in the middle of a coarse leaf's edge, the two sides would differ. Such a vertex
 * gets the mean of the edge's ends, as on the coarse side; edges are treated from coarse
 * to fine, so that the ends are settled first. The result is continuous on every smooth
 * surface, but for T-junctions of the input mesh itself. */
#include "io/picture/shading.h"

#include <math.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "io/picture/surface.h"

/* --- leaves, and their covered parts --- */

/* Calls `visit` for each leaf of the level (-1: of any), roots in order, depth first. */
static void for_each_leaf(const struct forest *forest, int level,
                          void (*visit)(void *context, int32_t leaf), void *context)
{
    for (int32_t root = 0; root < forest->root_count; root++) {
        if (scene_root_area(forest->scene, root) <= 0.0)
            continue;
        for (int32_t p = root; p >= 0 && !stop_is_asked();) {
            int at = id_level(forest->patches[p].id);
            if (patch_is_leaf(&forest->patches[p]) && (level < 0 || at == level))
                visit(context, p);
            p = forest_next(forest, p, level < 0 || at < level);
        }
    }
}

/* A gap is narrow for a leaf if it is less than this part of the distance from the middle
 * to a corner of its quarter. */
static const double NARROW = 0.1;

/* Parts of a leaf that are examined where some are covered. */
enum { OPEN_PARTS = 16 };

struct survey {
    const struct forest *forest;
    const struct octree *octree;
    int64_t count;       /* leaves visited */
    int64_t first, step; /* the leaves to examine: first, first + step, ... */
    uint8_t *open;       /* [count]; NULL: leaves are only counted */
};

/* True if the ray from a point of the plane meets a back, or a front less than `gap`
 * above the plane. */
static bool is_shut(const struct survey *survey, const struct plane *plane,
                    struct vec3 start, struct vec3 direction, double gap)
{
    const struct scene *scene = survey->forest->scene;
    struct octree_counts counts = {0};
    struct octree_hit hit;
    if (!octree_first_hit(survey->octree, start, direction, false, &hit, &counts))
        return false;
    if (scene_root_on(scene, hit.triangle, hit.front) < 0)
        return true;
    const struct triangle *t = &scene->triangles[hit.triangle];
    double height = 0.0;
    for (int k = 0; k < 3; k++)
        height += hit.weight[k] * plane_distance(plane, t->corner[k]);
    return height < gap;
}

/* True if the middle of a triangle is covered, whose corners give three directions along
 * the surface. `gap`: the width of a narrow gap, scene units. */
static bool is_covered(const struct survey *survey, const struct plane *plane,
                       const struct triangle *part, double gap)
{
    struct vec3 point = triangle_centroid(part);
    struct vec3 rise = vec3_scale(plane->normal, 1024.0 * GEOM_ROUNDING);
    struct vec3 start = vec3_add(point, rise);
    if (!is_shut(survey, plane, start, plane->normal, gap))
        return false;
    for (int k = 0; k < 3; k++) {
        struct vec3 along = vec3_sub(part->corner[k], point);
        struct vec3 up = vec3_scale(plane->normal, 0.25 * vec3_length(along));
        if (!is_shut(survey, plane, start, vec3_add(along, up), gap))
            return false;
    }
    return true;
}

/* Counts the quarters of a triangle whose middles are open. */
static int open_quarters(const struct survey *survey, const struct plane *plane,
                         const struct triangle *t, double gap)
{
    int open = 0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(t, k);
        open += !is_covered(survey, plane, &child, gap);
    }
    return open;
}

static void survey_leaf(void *context, int32_t leaf)
{
    struct survey *survey = context;
    const struct forest *forest = survey->forest;
    int64_t number = survey->count++;
    if (!survey->open || number % survey->step != survey->first)
        return;
    struct triangle t = forest_triangle(forest, leaf);
    struct plane plane =
        scene_root_plane(forest->scene, (int32_t)forest->patches[leaf].id.root);
    struct triangle quarter = triangle_child(&t, 0);
    double gap = NARROW * vec3_length(vec3_sub(quarter.corner[0],
                                               triangle_centroid(&quarter)));
    if (open_quarters(survey, &plane, &t, gap) == 4)
        survey->open[number] = OPEN_PARTS;
    for (int k = 0; k < 4 && survey->open[number] < OPEN_PARTS; k++) {
        quarter = triangle_child(&t, k);
        survey->open[number] += (uint8_t)open_quarters(survey, &plane, &quarter, gap);
    }
}

uint8_t *shading_open_parts(const struct forest *forest, const struct octree *octree,
                            int first, int step, int64_t *count)
{
    struct survey survey = {forest, octree, 0, first, step, NULL};
    for_each_leaf(forest, -1, survey_leaf, &survey);
    *count = survey.count;
    survey.open = alloc_array((size_t)survey.count, sizeof *survey.open);
    survey.count = 0;
    for_each_leaf(forest, -1, survey_leaf, &survey);
    return survey.open;
}

/* --- vertices: a hash table from (point, surface) to a number --- */

struct table {
    struct vec3 *positions;  /* [count] scene units */
    struct rgb *values;      /* [count] sum of weighted radiosities, then mean, W/m^2 */
    double *weights;         /* [count] sum of the weights, of corrections the areas */
    int32_t *surfaces;       /* [count] */
    int64_t count, capacity;
    int32_t *slots;          /* [slot_count] a vertex, or -1 */
    int64_t slot_count;      /* a power of two */
};

static uint64_t hash_point(struct vec3 x, int32_t surface)
{
    const double values[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* no negative zeros */
    uint64_t hash = (uint64_t)(uint32_t)surface;
    for (int k = 0; k < 3; k++) {
        uint64_t bits;
        memcpy(&bits, &values[k], sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9E3779B97F4A7C15);
        hash ^= hash >> 29;
    }
    return hash;
}

static bool is_same_point(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Returns the slot of the vertex, or the free slot where it belongs. */
static int64_t find_slot(const struct table *table, struct vec3 x, int32_t surface)
{
    int64_t slot = (int64_t)(hash_point(x, surface) & (uint64_t)(table->slot_count - 1));
    for (;; slot = (slot + 1) & (table->slot_count - 1)) {
        int32_t vertex = table->slots[slot];
        if (vertex < 0 || (table->surfaces[vertex] == surface &&
                           is_same_point(table->positions[vertex], x)))
            return slot;
    }
}

static void grow_slots(struct table *table)
{
    alloc_free(table->slots);
    table->slot_count = table->slot_count ? 2 * table->slot_count : 1024;
    table->slots = alloc_array((size_t)table->slot_count, sizeof *table->slots);
    for (int64_t slot = 0; slot < table->slot_count; slot++)
        table->slots[slot] = -1;
    for (int64_t v = 0; v < table->count; v++)
        table->slots[find_slot(table, table->positions[v], table->surfaces[v])] =
            (int32_t)v;
}

static int32_t append_vertex(struct table *table, struct vec3 x, int32_t surface)
{
    int64_t needed = table->count + 1;
    if (needed > INT32_MAX)
        alloc_fail(SIZE_MAX);
    if (needed > table->capacity) {
        RESERVE(table->positions, &table->capacity, needed);
        size_t room = (size_t)table->capacity;
        table->values = alloc_resize(table->values, room, sizeof *table->values);
        table->weights = alloc_resize(table->weights, room, sizeof *table->weights);
        table->surfaces = alloc_resize(table->surfaces, room, sizeof *table->surfaces);
    }
    int32_t vertex = (int32_t)table->count++;
    table->positions[vertex] = x;
    table->values[vertex] = (struct rgb){{0.0, 0.0, 0.0}};
    table->weights[vertex] = 0.0;
    table->surfaces[vertex] = surface;
    return vertex;
}

static int32_t reach_vertex(struct table *table, struct vec3 x, int32_t surface)
{
    if (2 * (table->count + 1) > table->slot_count)
        grow_slots(table);
    int64_t slot = find_slot(table, x, surface);
    if (table->slots[slot] < 0)
        table->slots[slot] = append_vertex(table, x, surface);
    return table->slots[slot];
}

static void add_value(struct table *table, int32_t vertex, struct rgb value,
                      double weight)
{
    table->weights[vertex] += weight;
    for (int c = 0; c < BANDS; c++)
        table->values[vertex].band[c] += weight * value.band[c];
}

static void find_means(struct table *table)
{
    for (int64_t v = 0; v < table->count; v++)
        for (int c = 0; c < BANDS; c++)
            table->values[v].band[c] /= table->weights[v];
}

/* Frees all but positions and values, which the caller takes over. */
static void drop_index(struct table *table)
{
    alloc_free(table->weights);
    alloc_free(table->surfaces);
    alloc_free(table->slots);
}

/* --- values --- */

/* Corrections of light without that of lamps. */
enum { ROUNDS = 4 };

/* Weight of a covered leaf: it counts only at vertices without open leaves. */
static const double COVERED = 1e-12;

/* Returns the open fraction of a leaf: 1/4 to 1; with fewer open parts it counts as
 * covered: 0. */
static double open_fraction(uint8_t parts)
{
    return parts < 4 ? 0.0 : (double)parts / OPEN_PARTS;
}

/* Returns the radiosity of the open part of a leaf, less less[leaf]. The whole irradiance
 * of the leaf falls on its open part. */
static struct rgb open_radiosity(const struct forest *forest, const struct rgb *less,
                                 int32_t leaf, double fraction)
{
    struct rgb b = forest->radiosity[leaf],
               e = forest_material(forest, leaf)->emission;
    for (int c = 0; c < BANDS && less; c++)
        b.band[c] = fmax(e.band[c], b.band[c] - less[leaf].band[c]);
    for (int c = 0; c < BANDS && fraction > 0.0; c++)
        b.band[c] = e.band[c] + (b.band[c] - e.band[c]) / fraction;
    return b;
}

/* --- all leaves --- */

struct blend {
    struct shading *shading;
    struct table table;
    const struct rgb *less; /* [patches] radiosity to subtract, W/m^2, or NULL */
    const float *error;     /* [patches] of radiosity, two deviations, W/m^2, or NULL */
    const uint8_t *open;    /* of shading_open_parts() */
    bool is_last;           /* of the corrections: it takes deficits as they are */
    int64_t next;           /* number of the next leaf in canonical order */
    int32_t *surface;       /* [roots] of surface_of_roots() */
    struct rgb *lacking;    /* [vertex_count] sum of area times deficit of leaves, W */
    struct rgb *least;      /* [vertex_count] least value of open leaves around, W/m^2 */
    struct rgb *most;       /* [vertex_count] largest value of them, W/m^2 */
};

static void add_flat_leaf(void *context, int32_t leaf)
{
    struct blend *blend = context;
    const struct forest *forest = blend->shading->forest;
    struct triangle t = forest_triangle(forest, leaf);
    for (int k = 0; k < 3; k++) {
        int32_t v = append_vertex(&blend->table, t.corner[k],
                                  (int32_t)forest->patches[leaf].id.root);
        blend->shading->corners[3 * (int64_t)leaf + k] = v;
        add_value(&blend->table, v, forest->radiosity[leaf], 1.0);
    }
}

/* Returns the value of the next leaf, and sets `*fraction` to its open fraction. */
static struct rgb leaf_value(struct blend *blend, int32_t leaf, double *fraction)
{
    *fraction = open_fraction(blend->open[blend->next++]);
    return open_radiosity(blend->shading->forest, blend->less, leaf, *fraction);
}

static void add_leaf(void *context, int32_t leaf)
{
    struct blend *blend = context;
    const struct forest *forest = blend->shading->forest;
    struct triangle t = forest_triangle(forest, leaf);
    double fraction;
    struct rgb value = leaf_value(blend, leaf, &fraction);
    for (int k = 0; k < 3; k++) {
        int32_t v = reach_vertex(&blend->table, t.corner[k],
                                 blend->surface[forest->patches[leaf].id.root]);
        blend->shading->corners[3 * (int64_t)leaf + k] = v;
        add_value(&blend->table, v, value, fmax(fraction, COVERED));
    }
}

/* Interpolates all vertices inside the edge from u to v between its ends. Recurses down
 * to an edge without a vertex in its middle, at most ID_MAX_LEVEL halvings. */
static void settle_edge(struct table *table, int32_t u, int32_t v)
{
    struct vec3 x = vec3_middle(table->positions[u], table->positions[v]);
    int32_t middle = table->slots[find_slot(table, x, table->surfaces[u])];
    if (middle < 0)
        return;
    for (int c = 0; c < BANDS; c++)
        table->values[middle].band[c] =
            0.5 * (table->values[u].band[c] + table->values[v].band[c]);
    settle_edge(table, u, middle);
    settle_edge(table, middle, v);
}

static void settle_leaf(void *context, int32_t leaf)
{
    struct blend *blend = context;
    const int32_t *corner = &blend->shading->corners[3 * (int64_t)leaf];
    for (int k = 0; k < 3; k++)
        settle_edge(&blend->table, corner[k], corner[(k + 1) % 3]);
}

static void settle_edges(struct blend *blend)
{
    for (int level = 0; level <= ID_MAX_LEVEL; level++)
        for_each_leaf(blend->shading->forest, level, settle_leaf, blend);
}

/* Returns the deficit of a leaf, less its noise. */
static struct rgb deficit_of(const struct blend *blend, int32_t leaf, struct rgb value,
                             double fraction)
{
    const int32_t *corner = &blend->shading->corners[3 * (int64_t)leaf];
    struct rgb deficit;
    double largest = 0.0, share = 1.0;
    for (int c = 0; c < BANDS; c++) {
        deficit.band[c] = value.band[c];
        for (int k = 0; k < 3; k++)
            deficit.band[c] -= blend->table.values[corner[k]].band[c] / 3.0;
        largest = fmax(largest, fabs(deficit.band[c]));
    }
    if (blend->less && blend->error && !blend->is_last && fraction > 0.0 &&
        largest > 0.0) {
        double part = 0.5 * (double)blend->error[leaf] / (fraction * largest);
        share = fmax(0.0, 1.0 - part * part);
    }
    for (int c = 0; c < BANDS; c++)
        deficit.band[c] *= share;
    return deficit;
}

static void add_lacking(void *context, int32_t leaf)
{
    struct blend *blend = context;
    const int32_t *corner = &blend->shading->corners[3 * (int64_t)leaf];
    double fraction;
    struct rgb value = leaf_value(blend, leaf, &fraction);
    struct rgb deficit = deficit_of(blend, leaf, value, fraction);
    double area = fmax(fraction, COVERED) * forest_area(blend->shading->forest, leaf);
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < BANDS; c++) {
            double *least = &blend->least[corner[k]].band[c];
            double *most = &blend->most[corner[k]].band[c];
            blend->lacking[corner[k]].band[c] += area * deficit.band[c];
            *least = fraction > 0.0 ? fmin(*least, value.band[c]) : *least;
            *most = fraction > 0.0 ? fmax(*most, value.band[c]) : *most;
        }
        blend->table.weights[corner[k]] += area;
    }
}

/* Adds the mean deficit of the leaves around to each vertex; a vertex with only covered
 * leaves around it keeps its value. */
static void give_what_lacks(struct blend *blend)
{
    size_t count = (size_t)blend->table.count;
    blend->lacking = alloc_array(count, sizeof *blend->lacking);
    blend->least = alloc_array(count, sizeof *blend->least);
    blend->most = alloc_array(count, sizeof *blend->most);
    for (size_t v = 0; v < count; v++) {
        blend->table.weights[v] = 0.0;
        blend->least[v] = (struct rgb){{HUGE_VAL, HUGE_VAL, HUGE_VAL}};
        blend->most[v] = (struct rgb){{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    }
    blend->next = 0;
    for_each_leaf(blend->shading->forest, -1, add_lacking, blend);
    for (size_t v = 0; v < count; v++)
        for (int c = 0; c < BANDS && blend->least[v].band[c] <= blend->most[v].band[c];
             c++) {
            double *value = &blend->table.values[v].band[c];
            double low = blend->less ? 0.0 : blend->least[v].band[c];
            double high = blend->less ? HUGE_VAL : blend->most[v].band[c];
            *value += blend->lacking[v].band[c] / blend->table.weights[v];
            *value = fmin(high, fmax(low, *value));
        }
    alloc_free(blend->lacking);
    alloc_free(blend->least);
    alloc_free(blend->most);
}

static void blend_leaves(struct blend *blend)
{
    const struct forest *forest = blend->shading->forest;
    blend->surface = surface_of_roots(forest->scene);
    for_each_leaf(forest, -1, add_leaf, blend);
    find_means(&blend->table);
    settle_edges(blend);
    for (int round = blend->less ? ROUNDS : 1; round > 0; round--) {
        blend->is_last = round == 1;
        give_what_lacks(blend);
        settle_edges(blend);
    }
    alloc_free(blend->surface);
}

struct shading *shading_create(const struct forest *forest, const struct rgb *less,
                               const float *error, const uint8_t *open)
{
    struct shading *shading = alloc_array(1, sizeof *shading);
    shading->forest = forest;
    shading->flat = !open;
    shading->corners = alloc_array(3 * (size_t)forest->count, sizeof *shading->corners);
    struct blend blend = {.shading = shading, .less = less, .error = error, .open = open};
    if (shading->flat)
        for_each_leaf(forest, -1, add_flat_leaf, &blend);
    else
        blend_leaves(&blend);
    drop_index(&blend.table);
    shading->positions = blend.table.positions;
    shading->values = blend.table.values;
    shading->vertex_count = blend.table.count;
    return shading;
}

void shading_destroy(struct shading *shading)
{
    if (!shading)
        return;
    alloc_free(shading->corners);
    alloc_free(shading->positions);
    alloc_free(shading->values);
    alloc_free(shading);
}

struct rgb shading_at(const struct shading *shading, int32_t root, const double weight[3])
{
    const struct forest *forest = shading->forest;
    double w[3] = {weight[0], weight[1], weight[2]};
    int32_t leaf = root;
    while (!patch_is_leaf(&forest->patches[leaf]))
        leaf = forest->patches[leaf].children + triangle_child_at(w);
    const int32_t *corner = &shading->corners[3 * (int64_t)leaf];
    if (shading->flat)
        return shading->values[corner[0]];
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < BANDS; c++)
            sum.band[c] += w[k] * shading->values[corner[k]].band[c];
    return sum;
}
