/* Vertices.
 *
 * A hash table leads from a point and a surface to its vertex. A wall without thickness,
 * or one that stands on a floor along edges of leaves, has the light of two rooms on its
 * sides, and leaves on both sides have corners in common. So a vertex is parted: the
 * leaves around it, those in whose edge it lies included, are joined two by two if a way
 * from one to the other, just above the surface beside the vertex, is free. Each group of
 * joined leaves has a vertex of its own. A wall that ends at the vertex is walked round.
 *
 * Rejected: telling by the roots at a common edge whether one stands between two others.
 * A wall may stand on the inside of a floor, or on a part of an edge, and its edges may
 * be others than the floor's. */
#include "io/picture/vertices.h"

#include "geom/alloc.h"
#include "geom/hash.h"
#include "geom/stop.h"

/* --- the hash table --- */

/* Returns the slot of the vertex, or the free slot for a new one. */
static int64_t find_slot(const struct vertices *vertices, struct vec3 x, int32_t surface)
{
    int64_t mask = vertices->slot_count - 1;
    int64_t slot = (int64_t)(hash_point((uint64_t)(uint32_t)surface, x) & (uint64_t)mask);
    for (;; slot = (slot + 1) & mask) {
        int32_t vertex = vertices->slots[slot];
        if (vertex < 0 || (vertices->surfaces[vertex] == surface &&
                           vec3_is_equal(vertices->positions[vertex], x)))
            return slot;
    }
}

/* Of parted vertices the first, which is known to all leaves, has the slot. */
static void grow_slots(struct vertices *vertices)
{
    alloc_free(vertices->slots);
    vertices->slot_count = vertices->slot_count ? 2 * vertices->slot_count : 1024;
    vertices->slots =
        alloc_array((size_t)vertices->slot_count, sizeof *vertices->slots);
    for (int64_t slot = 0; slot < vertices->slot_count; slot++)
        vertices->slots[slot] = -1;
    for (int64_t v = 0; v < vertices->count; v++) {
        int64_t slot = find_slot(vertices, vertices->positions[v], vertices->surfaces[v]);
        if (vertices->slots[slot] < 0)
            vertices->slots[slot] = (int32_t)v;
    }
}

int32_t vertices_append(struct vertices *vertices, struct vec3 x, int32_t surface)
{
    int64_t needed = vertices->count + 1;
    if (needed > INT32_MAX)
        alloc_fail(SIZE_MAX);
    if (needed > vertices->capacity) {
        RESERVE(vertices->positions, &vertices->capacity, needed);
        vertices->surfaces =
            alloc_resize(vertices->surfaces, (size_t)vertices->capacity,
                         sizeof *vertices->surfaces);
    }
    int32_t vertex = (int32_t)vertices->count++;
    vertices->positions[vertex] = x;
    vertices->surfaces[vertex] = surface;
    return vertex;
}

int32_t vertices_reach(struct vertices *vertices, struct vec3 x, int32_t surface)
{
    if (2 * (vertices->count + 1) > vertices->slot_count)
        grow_slots(vertices);
    int64_t slot = find_slot(vertices, x, surface);
    if (vertices->slots[slot] < 0)
        vertices->slots[slot] = vertices_append(vertices, x, surface);
    return vertices->slots[slot];
}

int32_t vertices_between(const struct vertices *vertices, int32_t u, int32_t v,
                         int32_t leaf)
{
    if (u < 0 || v < 0)
        return -1;
    const struct vec3 *positions = vertices->positions;
    struct vec3 x = vec3_middle(positions[u], positions[v]);
    int32_t middle = vertices->slots[find_slot(vertices, x, vertices->surfaces[u])];
    if (middle < 0 || vec3_is_equal(x, positions[u]) || vec3_is_equal(x, positions[v]))
        return -1;
    if (middle >= vertices->known || vertices->first_part[middle] < 0)
        return middle;
    const struct vertex_part *part = &vertices->parts[vertices->first_part[middle]];
    while (part->leaf != leaf)
        part++;
    return part->vertex;
}

/* --- parting --- */

/* A leaf with a corner at a vertex, or with the vertex inside an edge. */
struct touch {
    int32_t vertex, leaf;
    bool corner;
};

struct touches {
    struct touch *items; /* [count] */
    int64_t count, capacity;
};

static void add_touch(struct touches *touches, struct touch touch)
{
    RESERVE(touches->items, &touches->capacity, touches->count + 1);
    touches->items[touches->count++] = touch;
}

/* Adds the vertices inside the edge from u to v of a leaf. */
static void touch_inside(const struct vertices *vertices, struct touches *touches,
                         int32_t u, int32_t v, int32_t leaf)
{
    int32_t middle = vertices_between(vertices, u, v, leaf);
    if (middle < 0)
        return;
    add_touch(touches, (struct touch){middle, leaf, false});
    touch_inside(vertices, touches, u, middle, leaf);
    touch_inside(vertices, touches, middle, v, leaf);
}

/* Returns the touches by vertex, and of a vertex in the order of leaves. `start`:
 * [vertices->count + 1], where those of a vertex begin. */
static struct touch *find_touches(const struct vertices *vertices,
                                  const struct forest *forest, const int32_t *corners,
                                  int64_t *start)
{
    struct touches found = {0};
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0 && !stop_is_asked(); leaf = forest_next_leaf(forest, leaf)) {
        const int32_t *corner = &corners[3 * (int64_t)leaf];
        if (scene_is_sky(forest->scene, (int32_t)forest->patches[leaf].id.root))
            continue;
        for (int k = 0; k < 3; k++)
            add_touch(&found, (struct touch){corner[k], leaf, true});
        for (int k = 0; k < 3; k++)
            touch_inside(vertices, &found, corner[k], corner[(k + 1) % 3], leaf);
    }
    struct touch *sorted = alloc_array((size_t)found.count, sizeof *sorted);
    for (int64_t i = 0; i < found.count; i++)
        start[found.items[i].vertex + 1]++;
    for (int64_t v = 0; v < vertices->count; v++)
        start[v + 1] += start[v];
    for (int64_t i = found.count; i-- > 0;) /* backwards, filling from the ends */
        sorted[--start[found.items[i].vertex + 1]] = found.items[i];
    for (int64_t v = 0; v < vertices->count; v++)
        start[v] = start[v + 1];
    start[vertices->count] = found.count;
    alloc_free(found.items);
    return sorted;
}

/* The place of a leaf beside a vertex. */
struct beside {
    struct vec3 at, normal;
    double height; /* above the leaf, scene units */
    int32_t input; /* triangle */
};

static struct beside beside_vertex(const struct forest *forest, struct vec3 x,
                                   int32_t leaf)
{
    static const double NEAR = 0.0625; /* part of the way to the leaf's middle */
    static const double LOW = 0.015625; /* over that part, for edges with few digits */
    int32_t root = (int32_t)forest->patches[leaf].id.root;
    struct triangle t = forest_triangle(forest, leaf);
    struct vec3 inwards = vec3_scale(vec3_sub(triangle_centroid(&t), x), NEAR);
    struct vec3 normal = scene_root_plane(forest->scene, root).normal;
    double height = LOW * vec3_length(inwards);
    struct vec3 at = vec3_add(vec3_add(x, inwards), vec3_scale(normal, height));
    return (struct beside){at, normal, height, scene_input_of(forest->scene, root)};
}

static bool is_blocked(const struct octree *octree, struct vec3 from, struct vec3 to,
                       const int32_t own[2])
{
    struct octree_counts counts = {0};
    int32_t guess = -1;
    return octree_blocks_segment(octree, from, to, own, &guess, &counts);
}

/* True if the way between two places beside the vertex x is free: a straight one, or,
 * where the surface bulges, one by a point above both leaves' planes. */
static bool is_way_free(const struct octree *octree, struct vec3 x,
                        const struct beside *a, const struct beside *b)
{
    static const double STEEPEST = 0.1;
    int32_t own[2] = {a->input, b->input};
    struct vec3 middle = vec3_middle(a->at, b->at), up = vec3_add(a->normal, b->normal);
    double length = vec3_length(up), rise = 0.0;
    const struct beside *ends[2] = {a, b};
    if (!(length > STEEPEST))
        return false;
    up = vec3_scale(up, 1.0 / length);
    for (int k = 0; k < 2; k++) {
        double height = vec3_dot(vec3_sub(middle, x), ends[k]->normal);
        double least = 0.5 * real_min(a->height, b->height);
        rise = real_max(rise, (least - height) / vec3_dot(up, ends[k]->normal));
    }
    if (!(rise > 0.0))
        return !is_blocked(octree, a->at, b->at, own);
    middle = vec3_add(middle, vec3_scale(up, rise));
    return !is_blocked(octree, a->at, middle, own) &&
           !is_blocked(octree, middle, b->at, own);
}

static int64_t first_of(int64_t *group, int64_t i)
{
    while (group[i] != i)
        i = group[i] = group[group[i]];
    return i;
}

/* Groups the leaves that touch a vertex: group[i] becomes the first of the i-th's group.
 * Returns whether there are several groups. Each is tried with the MOST before it. */
static bool group_leaves(const struct forest *forest, const struct octree *octree,
                         struct vec3 x, const struct touch *touches, int64_t count,
                         struct beside *beside, int64_t *group)
{
    enum { MOST = 64 };
    int64_t groups = 0;
    for (int64_t i = 0; i < count; i++) {
        beside[i] = beside_vertex(forest, x, touches[i].leaf);
        group[i] = i;
        groups++;
        for (int64_t j = i - 1; j >= 0 && j >= i - MOST && groups > 1; j--) {
            int64_t a = first_of(group, i), b = first_of(group, j);
            if (a == b || !is_way_free(octree, x, &beside[i], &beside[j]))
                continue;
            group[a > b ? a : b] = a < b ? a : b;
            groups--;
        }
    }
    for (int64_t i = 0; i < count; i++)
        group[i] = first_of(group, i);
    return groups > 1;
}

/* Gives each group with a corner at the vertex a vertex; the first one keeps it. */
static void part_vertex(struct vertices *vertices, int32_t vertex,
                        const struct touch *touches, int64_t count, const int64_t *group,
                        int32_t *corners)
{
    int64_t first = vertices->part_count;
    bool kept = false;
    RESERVE(vertices->parts, &vertices->part_capacity, first + count);
    vertices->first_part[vertex] = first;
    vertices->part_count += count;
    struct vertex_part *parts = &vertices->parts[first];
    for (int64_t i = 0; i < count; i++)
        parts[i] = (struct vertex_part){touches[i].leaf, -1};
    for (int64_t i = 0; i < count; i++) {
        if (!touches[i].corner || parts[i].vertex >= 0)
            continue;
        int32_t own = kept ? vertices_append(vertices, vertices->positions[vertex],
                                             vertices->surfaces[vertex])
                           : vertex;
        kept = true;
        for (int64_t j = 0; j < count; j++)
            if (group[j] == group[i])
                parts[j].vertex = own;
    }
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < 3 && touches[i].corner; k++)
            if (corners[3 * (int64_t)touches[i].leaf + k] == vertex)
                corners[3 * (int64_t)touches[i].leaf + k] = parts[i].vertex;
}

void vertices_part(struct vertices *vertices, const struct forest *forest,
                   const struct octree *octree, int32_t *corners)
{
    int64_t count = vertices->count, most = 0;
    int64_t *start = alloc_array((size_t)count + 1, sizeof *start);
    struct touch *touches = find_touches(vertices, forest, corners, start);
    vertices->first_part = alloc_array((size_t)count, sizeof *vertices->first_part);
    for (int64_t v = 0; v < count; v++) {
        vertices->first_part[v] = -1;
        most = start[v + 1] - start[v] > most ? start[v + 1] - start[v] : most;
    }
    vertices->known = count;
    struct beside *beside = alloc_array((size_t)most, sizeof *beside);
    int64_t *group = alloc_array((size_t)most, sizeof *group);
    for (int64_t v = 0; v < count && !stop_is_asked(); v++) {
        const struct touch *own = &touches[start[v]];
        int64_t around = start[v + 1] - start[v];
        if (group_leaves(forest, octree, vertices->positions[v], own, around, beside,
                         group))
            part_vertex(vertices, (int32_t)v, own, around, group, corners);
    }
    alloc_free(group);
    alloc_free(beside);
    alloc_free(touches);
    alloc_free(start);
}

void vertices_free(struct vertices *vertices)
{
    alloc_free(vertices->positions);
    alloc_free(vertices->surfaces);
    alloc_free(vertices->slots);
    alloc_free(vertices->parts);
    alloc_free(vertices->first_part);
    *vertices = (struct vertices){0};
}
