/* Smooth shading.
 *
 * A vertex is a corner of leaves. Leaves share a vertex where they have the same point and lie
 * on one smooth surface: roots of one material that meet in a common edge (the same end points,
 * to the bit) and whose planes agree within 2.5 degrees. The value of a vertex is the mean of
 * the leaves around it, each weighted by one over the distance of its centroid: a linear
 * function comes out right where the leaves lie evenly around the vertex, whatever their sizes.
 *
 * Where a box stands on the floor, leaves are covered in part. The covered part is dark, is not
 * seen and must not leak. It is found with the four points where the rays of the leaf's links
 * begin: a point is covered if four rays from it, up and far aside, all meet a back first: it
 * lies inside a solid, not merely below a shelf. The light of the leaf then belongs to its open
 * share: the irradiance that is shown is the leaf's over that share. A vertex with nothing but
 * covered leaves around it takes their mean.
 *
 * Between the vertices a leaf interpolates linearly. That alone would crack at T-vertices, where
 * a fine leaf has a vertex in the middle of a coarse leaf's edge: the coarse side does not know
 * of it. Such a vertex gets the mean of the edge's ends, which is what the coarse side shows
 * there; edges are treated from coarse to fine, so the ends are settled before. The result is
 * continuous on every smooth surface; T-junctions of the input mesh itself are not joined. */
#include "io/shading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"

static const double SMOOTH_COSINE = 0.999;

/* --- smooth surfaces: roots joined over common edges --- */

struct root_edge {
    struct vec3 low, high; /* end points, in lexical order */
    int32_t root;
};

static int compare_points(struct vec3 a, struct vec3 b)
{
    if (a.x != b.x)
        return a.x < b.x ? -1 : 1;
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return (a.z > b.z) - (a.z < b.z);
}

static int compare_edges(const void *left, const void *right)
{
    const struct root_edge *a = left, *b = right;
    int order = compare_points(a->low, b->low);
    order = order ? order : compare_points(a->high, b->high);
    return order ? order : (a->root > b->root) - (a->root < b->root);
}

static int32_t surface_of(int32_t *surface, int32_t root)
{
    while (surface[root] != root)
        root = surface[root] = surface[surface[root]];
    return root;
}

static bool is_smooth(const struct scene *scene, int32_t a, int32_t b)
{
    struct plane plane_a = scene_root_plane(scene, a), plane_b = scene_root_plane(scene, b);
    return scene_root_material(scene, a) == scene_root_material(scene, b) &&
           vec3_dot(plane_a.normal, plane_b.normal) >= SMOOTH_COSINE;
}

/* surface[root]: a number that all roots of one smooth surface share. */
static int32_t *find_surfaces(const struct scene *scene)
{
    int32_t roots = scene_root_count(scene);
    int32_t *surface = alloc_array((size_t)roots, sizeof *surface);
    struct root_edge *edges = alloc_array(3 * (size_t)roots, sizeof *edges);
    size_t count = 0;
    for (int32_t root = 0; root < roots; root++) {
        struct triangle t = scene_root_triangle(scene, root);
        surface[root] = root;
        for (int k = 0; k < 3 && scene_root_area(scene, root) > 0.0; k++) {
            struct vec3 a = t.corner[k], b = t.corner[(k + 1) % 3];
            bool ordered = compare_points(a, b) <= 0;
            edges[count++] = (struct root_edge){ordered ? a : b, ordered ? b : a, root};
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1; j < count && compare_points(edges[i].low, edges[j].low) == 0 &&
                               compare_points(edges[i].high, edges[j].high) == 0; j++)
            if (is_smooth(scene, edges[i].root, edges[j].root))
                surface[surface_of(surface, edges[i].root)] = surface_of(surface, edges[j].root);
    }
    for (int32_t root = 0; root < roots; root++)
        surface[root] = surface_of(surface, root);
    alloc_free(edges);
    return surface;
}

/* --- leaves, and how much of each is covered --- */

/* Calls for each leaf of the wanted level (-1: of any), roots in order, depth first. */
static void for_each_leaf(const struct forest *forest, int level,
                          void (*visit)(void *context, int32_t leaf), void *context)
{
    for (int32_t root = 0; root < forest->root_count; root++) {
        if (scene_root_area(forest->scene, root) <= 0.0)
            continue;
        for (int32_t p = root; p >= 0;) {
            int at = id_level(forest->patches[p].id);
            if (patch_is_leaf(&forest->patches[p]) && (level < 0 || at == level))
                visit(context, p);
            p = forest_next(forest, p, level < 0 || at < level);
        }
    }
}

static bool meets_back(const struct octree *octree, struct vec3 start, struct vec3 direction)
{
    struct octree_counts counts = {0};
    struct octree_hit hit;
    return octree_first_hit(octree, start, direction, false, &hit, &counts) && !hit.front;
}

/* `aside`: a triangle about the point, whose corners give three directions along the surface. */
static bool is_covered(const struct octree *octree, struct vec3 point, struct vec3 normal,
                       const struct triangle *aside)
{
    struct vec3 start = vec3_add(point, vec3_scale(normal, 1024.0 * GEOM_ROUNDING));
    if (!meets_back(octree, start, normal))
        return false;
    for (int k = 0; k < 3; k++) {
        struct vec3 along = vec3_sub(aside->corner[k], point);
        struct vec3 up = vec3_scale(normal, 0.25 * vec3_length(along));
        if (!meets_back(octree, start, vec3_add(along, up)))
            return false;
    }
    return true;
}

struct survey {
    const struct forest *forest;
    const struct octree *octree;
    int64_t count, first, step; /* leaves seen, those to look at */
    uint8_t *open;              /* [count], NULL while only counting */
};

static void survey_leaf(void *context, int32_t leaf)
{
    struct survey *survey = context;
    const struct forest *forest = survey->forest;
    int64_t number = survey->count++;
    if (!survey->open || number % survey->step != survey->first)
        return;
    struct triangle t = forest_triangle(forest, leaf);
    struct plane plane = scene_root_plane(forest->scene, (int32_t)forest->patches[leaf].id.root);
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(&t, k);
        if (forest->scene->two_sided ||
            !is_covered(survey->octree, triangle_centroid(&child), plane.normal, &child))
            survey->open[number]++;
    }
}

uint8_t *shading_open_quarters(const struct forest *forest, const struct octree *octree, int first,
                               int step, int64_t *count)
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
    struct shading *shading;
    const uint8_t *open;     /* [leaves] shading_open_quarters(), used up leaf by leaf */
    int32_t *surface;        /* [roots] */
    int32_t *vertex_surface; /* [vertex_count] */
    double *weights;         /* [vertex_count] sum of the weights of the leaves around */
    int64_t capacity;        /* of the vertex arrays */
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

/* The slot that holds the vertex, or the free one where it would go. */
static int64_t find_slot(const struct table *table, struct vec3 x, int32_t surface)
{
    int64_t slot = (int64_t)(hash_point(x, surface) & (uint64_t)(table->slot_count - 1));
    for (;; slot = (slot + 1) & (table->slot_count - 1)) {
        int32_t vertex = table->slots[slot];
        if (vertex < 0 || (table->vertex_surface[vertex] == surface &&
                           compare_points(table->shading->positions[vertex], x) == 0))
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
    for (int64_t v = 0; v < table->shading->vertex_count; v++)
        table->slots[find_slot(table, table->shading->positions[v], table->vertex_surface[v])] =
            (int32_t)v;
}

static int32_t append_vertex(struct table *table, struct vec3 x, int32_t surface)
{
    struct shading *shading = table->shading;
    int64_t needed = shading->vertex_count + 1;
    if (needed > INT32_MAX)
        alloc_fail(SIZE_MAX);
    if (needed > table->capacity) {
        int64_t capacity = table->capacity;
        shading->positions = alloc_reserve(shading->positions, &capacity, needed,
                                           sizeof *shading->positions);
        size_t room = (size_t)capacity;
        shading->values = alloc_resize(shading->values, room, sizeof *shading->values);
        table->vertex_surface = alloc_resize(table->vertex_surface, room,
                                             sizeof *table->vertex_surface);
        table->weights = alloc_resize(table->weights, room, sizeof *table->weights);
        table->capacity = capacity;
    }
    int32_t vertex = (int32_t)shading->vertex_count++;
    shading->positions[vertex] = x;
    shading->values[vertex] = (struct rgb){{0.0, 0.0, 0.0}};
    table->vertex_surface[vertex] = surface;
    table->weights[vertex] = 0.0;
    return vertex;
}

static int32_t reach_vertex(struct table *table, struct vec3 x, int32_t surface)
{
    if (2 * (table->shading->vertex_count + 1) > table->slot_count)
        grow_slots(table);
    int64_t slot = find_slot(table, x, surface);
    if (table->slots[slot] < 0)
        table->slots[slot] = append_vertex(table, x, surface);
    return table->slots[slot];
}

/* --- values --- */

/* Weight of a leaf that is covered as a whole: it counts only where no other leaf does. */
static const double COVERED = 1e-12;

/* Share of a leaf that is not covered: 1/2, 3/4 or 1; below, too little is known: 0. */
static double open_share(uint8_t quarters)
{
    return quarters < 2 ? 0.0 : 0.25 * quarters;
}

/* Radiosity of the open share of a leaf: what it receives, it receives there. */
static struct rgb open_radiosity(const struct forest *forest, int32_t leaf, double share)
{
    struct rgb b = forest->patches[leaf].radiosity, e = forest_material(forest, leaf)->emission;
    for (int c = 0; c < BANDS && share > 0.0; c++)
        b.band[c] = e.band[c] + (b.band[c] - e.band[c]) / share;
    return b;
}

static void add_leaf(void *context, int32_t leaf)
{
    struct table *table = context;
    struct shading *shading = table->shading;
    int32_t root = (int32_t)shading->forest->patches[leaf].id.root;
    struct triangle t = forest_triangle(shading->forest, leaf);
    struct vec3 centroid = triangle_centroid(&t);
    double share = shading->flat ? 1.0 : open_share(*table->open++);
    struct rgb radiosity = open_radiosity(shading->forest, leaf, share);
    for (int k = 0; k < 3; k++) {
        int32_t v = shading->flat ? append_vertex(table, t.corner[k], root)
                                  : reach_vertex(table, t.corner[k], table->surface[root]);
        double weight = fmax(share, COVERED) / vec3_length(vec3_sub(centroid, t.corner[k]));
        shading->corners[3 * (int64_t)leaf + k] = v;
        table->weights[v] += weight;
        for (int c = 0; c < BANDS; c++)
            shading->values[v].band[c] += weight * radiosity.band[c];
    }
}

/* Makes all vertices inside the edge from u to v follow the line between its ends. Ends at an
 * edge without a vertex in its middle, at most ID_MAX_LEVEL halvings down. */
static void settle_edge(struct table *table, int32_t u, int32_t v)
{
    struct shading *shading = table->shading;
    struct vec3 x = vec3_middle(shading->positions[u], shading->positions[v]);
    int32_t middle = table->slots[find_slot(table, x, table->vertex_surface[u])];
    if (middle < 0)
        return;
    for (int c = 0; c < BANDS; c++)
        shading->values[middle].band[c] =
            0.5 * (shading->values[u].band[c] + shading->values[v].band[c]);
    settle_edge(table, u, middle);
    settle_edge(table, middle, v);
}

static void settle_leaf(void *context, int32_t leaf)
{
    struct table *table = context;
    const int32_t *corner = &table->shading->corners[3 * (int64_t)leaf];
    for (int k = 0; k < 3; k++)
        settle_edge(table, corner[k], corner[(k + 1) % 3]);
}

struct shading *shading_create(const struct forest *forest, const uint8_t *open)
{
    bool flat = !open;
    struct shading *shading = alloc_array(1, sizeof *shading);
    shading->forest = forest;
    shading->flat = flat;
    shading->corners = alloc_array(3 * (size_t)forest->count, sizeof *shading->corners);
    struct table table = {.shading = shading, .open = open,
                          .surface = find_surfaces(forest->scene)};
    for_each_leaf(forest, -1, add_leaf, &table);
    for (int64_t v = 0; v < shading->vertex_count; v++)
        for (int c = 0; c < BANDS; c++)
            shading->values[v].band[c] /= table.weights[v];
    for (int level = 0; level <= ID_MAX_LEVEL && !flat; level++)
        for_each_leaf(forest, level, settle_leaf, &table);
    alloc_free(table.surface);
    alloc_free(table.vertex_surface);
    alloc_free(table.weights);
    alloc_free(table.slots);
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

/* Takes barycentric coordinates of a patch to those of the child that holds the point. */
static int descend(double w[3])
{
    for (int k = 0; k < 3; k++) {
        if (w[k] < 0.5)
            continue;
        /* children 0 = (a, ab, ca), 1 = (ab, b, bc), 2 = (ca, bc, c): corner k stays k */
        for (int i = 0; i < 3; i++)
            w[i] = i == k ? 2.0 * w[i] - 1.0 : 2.0 * w[i];
        return k;
    }
    for (int i = 0; i < 3; i++) /* child 3 = (bc, ca, ab) */
        w[i] = 1.0 - 2.0 * w[i];
    return 3;
}

struct rgb shading_at(const struct shading *shading, int32_t root, const double weight[3])
{
    const struct forest *forest = shading->forest;
    double w[3] = {weight[0], weight[1], weight[2]};
    int32_t leaf = root;
    while (!patch_is_leaf(&forest->patches[leaf]))
        leaf = forest->patches[leaf].children + descend(w);
    if (shading->flat)
        return forest->patches[leaf].radiosity;
    const int32_t *corner = &shading->corners[3 * (int64_t)leaf];
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < BANDS; c++)
            sum.band[c] += w[k] * shading->values[corner[k]].band[c];
    return sum;
}
