/* A loose octree.
 *
 *     cell (space)          what is stored
 *     +-----+-----+         node: box of its triangles, not of its cell
 *     |  /\ |     |           children 0..7 by the cell's octants, absent ones left out
 *     | /__\|_____|         leaf: a run of the array `order`
 *     |   \ | /\  |
 *     +-----+-----+
 *
 * A triangle belongs to the one cell that holds its centroid, however far it sticks out, and a
 * node keeps the tight box of all that is below it. So each triangle is referred to exactly
 * once, the tree has at most 2n nodes or so, no triangle is tested twice for a ray, and nothing
 * can fall between two cells. The price is that boxes overlap.
 *
 * Rejected: cells that list every triangle that touches them (several references a triangle,
 * marks against repeated tests, a build that clips polygons).
 *
 * A box is tested with the separating axis test on the segment's middle and half vector: no
 * division, so no infinities when a segment runs inside an axis plane, and one rounding bound
 * keeps it conservative. Children are visited front to back by flipping the octant number with
 * the signs of the direction; this is a good order, not a strict one, so the search for the
 * first hit goes on through all boxes that begin before the hit found so far. */
#include "octree/octree.h"

#include <stddef.h>

#include "geom/alloc.h"

enum {
    LEAF_SIZE = 8,
    MAX_DEPTH = 24,                /* ends the splitting of coincident centroids */
    STACK_SIZE = 7 * MAX_DEPTH + 8 /* each level leaves at most 7 siblings waiting */
};

struct node {
    struct vec3 middle, half; /* box: middle +- half */
    int32_t first;            /* first child node, or first entry of `order` for a leaf */
    int32_t count;            /* triangles of a leaf; 0 for an inner node */
    int8_t child[8];          /* octant -> number of the child behind `first`, or -1 */
};

struct octree {
    const struct triangle *triangles;
    const struct plane *planes;
    int32_t *order; /* triangle numbers, leaf by leaf */
    struct node *nodes;
    int64_t node_count, node_capacity;
};

/* --- construction --- */

/* A node that waits to be split: its cell and its run of `order`. */
struct cell {
    struct vec3 centre;
    double half;
    int32_t node, begin, end, depth;
};

static void box_of(struct octree *octree, int32_t begin, int32_t end, struct node *node)
{
    struct vec3 low = octree->triangles[octree->order[begin]].corner[0], high = low;
    for (int32_t i = begin; i < end; i++) {
        for (int k = 0; k < 3; k++) {
            struct vec3 x = octree->triangles[octree->order[i]].corner[k];
            low = (struct vec3){fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z)};
            high = (struct vec3){fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z)};
        }
    }
    node->middle = vec3_middle(low, high);
    node->half = vec3_scale(vec3_sub(high, low), 0.5);
}

static int octant_of(struct vec3 x, struct vec3 centre)
{
    return (x.x >= centre.x ? 1 : 0) | (x.y >= centre.y ? 2 : 0) | (x.z >= centre.z ? 4 : 0);
}

static struct cell child_cell(const struct cell *cell, int octant)
{
    double h = 0.5 * cell->half;
    struct vec3 step = {octant & 1 ? h : -h, octant & 2 ? h : -h, octant & 4 ? h : -h};
    return (struct cell){.centre = vec3_add(cell->centre, step), .half = h,
                         .depth = cell->depth + 1};
}

/* Sorts the cell's run of `order` by octant, keeping the order within each; start[k] is where
 * octant k begins. */
static void sort_by_octant(struct octree *octree, const struct cell *cell, int32_t *scratch,
                           int32_t start[9])
{
    int32_t size[8] = {0};
    for (int32_t i = cell->begin; i < cell->end; i++) {
        scratch[i] = octree->order[i];
        struct vec3 x = triangle_centroid(&octree->triangles[scratch[i]]);
        size[octant_of(x, cell->centre)]++;
    }
    start[0] = cell->begin;
    for (int k = 0; k < 8; k++)
        start[k + 1] = start[k] + size[k];
    int32_t next[8];
    for (int k = 0; k < 8; k++)
        next[k] = start[k];
    for (int32_t i = cell->begin; i < cell->end; i++) {
        struct vec3 x = triangle_centroid(&octree->triangles[scratch[i]]);
        octree->order[next[octant_of(x, cell->centre)]++] = scratch[i];
    }
}

static int32_t node_append(struct octree *octree)
{
    octree->nodes = alloc_reserve(octree->nodes, &octree->node_capacity, octree->node_count + 1,
                                  sizeof *octree->nodes);
    return (int32_t)octree->node_count++;
}

/* Cells are split in the order in which they were made (a queue, not recursion), so children
 * of a node lie side by side. */
static void split_cells(struct octree *octree, struct cell root)
{
    int64_t capacity = 0, count = 0;
    struct cell *queue = alloc_reserve(NULL, &capacity, 1, sizeof *queue);
    int32_t *scratch = alloc_array((size_t)root.end, sizeof *scratch);
    root.node = node_append(octree);
    queue[count++] = root;
    for (int64_t at = 0; at < count; at++) {
        struct cell cell = queue[at];
        struct node node = {.first = cell.begin, .count = cell.end - cell.begin};
        box_of(octree, cell.begin, cell.end, &node);
        if (node.count > LEAF_SIZE && cell.depth < MAX_DEPTH) {
            int32_t start[9];
            sort_by_octant(octree, &cell, scratch, start);
            node.first = (int32_t)octree->node_count;
            node.count = 0;
            int8_t children = 0;
            for (int k = 0; k < 8; k++) {
                node.child[k] = -1;
                if (start[k] == start[k + 1])
                    continue;
                struct cell child = child_cell(&cell, k);
                child.begin = start[k];
                child.end = start[k + 1];
                child.node = node_append(octree);
                node.child[k] = children++;
                queue = alloc_reserve(queue, &capacity, count + 1, sizeof *queue);
                queue[count++] = child;
            }
        }
        octree->nodes[cell.node] = node;
    }
    alloc_free(scratch);
    alloc_free(queue);
}

struct octree *octree_create(const struct triangle *triangles, const struct plane *planes,
                             int32_t count)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    octree->triangles = triangles;
    octree->planes = planes;
    octree->order = alloc_array((size_t)count, sizeof *octree->order);
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++)
        if (vec3_dot(planes[i].normal, planes[i].normal) > 0.0)
            octree->order[kept++] = i;
    if (kept > 0) {
        struct node box;
        box_of(octree, 0, kept, &box);
        double half = fmax(box.half.x, fmax(box.half.y, box.half.z));
        split_cells(octree, (struct cell){.centre = box.middle, .half = half, .end = kept});
    }
    return octree;
}

void octree_destroy(struct octree *octree)
{
    if (!octree)
        return;
    alloc_free(octree->order);
    alloc_free(octree->nodes);
    alloc_free(octree);
}

const struct triangle *octree_triangle(const struct octree *octree, int32_t triangle)
{
    return &octree->triangles[triangle];
}

const struct plane *octree_plane(const struct octree *octree, int32_t triangle)
{
    return &octree->planes[triangle];
}

/* --- queries --- */

/* A segment prepared for box tests. */
struct probe {
    struct vec3 middle, half, reach; /* reach: |half| */
};

static struct probe probe_make(struct vec3 from, struct vec3 to)
{
    struct probe p = {.middle = vec3_middle(from, to), .half = vec3_scale(vec3_sub(to, from), 0.5)};
    p.reach = (struct vec3){fabs(p.half.x), fabs(p.half.y), fabs(p.half.z)};
    return p;
}

/* Separating axes: the three of the box, and their cross products with the segment. */
static bool probe_meets_box(const struct probe *p, const struct node *node)
{
    struct vec3 d = vec3_sub(p->middle, node->middle), e = node->half, r = p->reach, h = p->half;
    double slack = GEOM_ROUNDING;
    if (fabs(d.x) > e.x + r.x + slack || fabs(d.y) > e.y + r.y + slack ||
        fabs(d.z) > e.z + r.z + slack)
        return false;
    return fabs(d.y * h.z - d.z * h.y) <= e.y * r.z + e.z * r.y + slack &&
           fabs(d.z * h.x - d.x * h.z) <= e.z * r.x + e.x * r.z + slack &&
           fabs(d.x * h.y - d.y * h.x) <= e.x * r.y + e.y * r.x + slack;
}

/* Puts the children of `node` on the stack, the nearest on top. `flip` has a bit for each axis
 * along which the segment runs downwards. Returns the new height. */
static int push_children(const struct node *node, int flip, int32_t *stack, int height)
{
    for (int k = 7; k >= 0; k--) {
        int child = node->child[k ^ flip];
        if (child >= 0)
            stack[height++] = node->first + child;
    }
    return height;
}

static int flip_of(struct vec3 direction)
{
    return (direction.x < 0.0 ? 1 : 0) | (direction.y < 0.0 ? 2 : 0) | (direction.z < 0.0 ? 4 : 0);
}

int32_t octree_blocker(const struct octree *octree, struct vec3 from, struct vec3 to,
                       const int32_t own[2], int32_t guess, struct octree_counts *counts)
{
    counts->rays++;
    struct segment segment = segment_make(from, to);
    if (guess >= 0 && guess != own[0] && guess != own[1]) {
        counts->triangle_tests++;
        if (segment_is_blocked_by(&segment, &octree->triangles[guess], &octree->planes[guess]))
            return guess;
    }
    struct probe probe = probe_make(from, to);
    int flip = flip_of(probe.half);
    int32_t stack[STACK_SIZE];
    int height = 0;
    if (octree->node_count > 0)
        stack[height++] = 0;
    while (height > 0) {
        const struct node *node = &octree->nodes[stack[--height]];
        counts->node_tests++;
        if (!probe_meets_box(&probe, node))
            continue;
        if (node->count == 0) {
            height = push_children(node, flip, stack, height);
            continue;
        }
        for (int32_t i = node->first; i < node->first + node->count; i++) {
            int32_t t = octree->order[i];
            if (t == own[0] || t == own[1])
                continue;
            counts->triangle_tests++;
            if (segment_is_blocked_by(&segment, &octree->triangles[t], &octree->planes[t]))
                return t;
        }
    }
    return -1;
}

/* Cuts the ray to a segment that ends behind everything and begins no further from the scene
 * than its own size: what a camera far away needs to keep its digits. False if it misses. */
static bool clip_to_scene(const struct node *root, struct vec3 *origin, struct vec3 direction,
                          struct vec3 *end)
{
    double length = vec3_length(direction);
    double radius = vec3_length(root->half) * 1.0001 + GEOM_ROUNDING;
    struct vec3 d = vec3_scale(direction, 1.0 / length);
    double along = vec3_dot(vec3_sub(root->middle, *origin), d);
    double begin = along - radius;
    if (along + radius <= 0.0)
        return false;
    *end = vec3_add(*origin, vec3_scale(d, along + radius));
    if (begin > 0.0)
        *origin = vec3_add(*origin, vec3_scale(d, begin));
    return true;
}

/* Of two triangles met in the same place, a front counts before a back (the wall of the next room
 * lies back to back with ours), then the one that comes later in the file. */
static bool wins_tie(const struct octree_hit *hit, int32_t t, bool front)
{
    return front != hit->front ? front : t > hit->triangle;
}

/* Tests one triangle; keeps it in `hit` and its parameter in `nearest` if it is met before that,
 * or in the same place and wins the tie. */
static bool improve_hit(const struct octree *octree, const struct segment *segment, int32_t t,
                        bool fronts_only, double *nearest, struct octree_hit *hit)
{
    const struct plane *plane = &octree->planes[t];
    double start = plane_distance(plane, segment->from), end = plane_distance(plane, segment->to);
    if ((start > 0.0) == (end > 0.0) || (fronts_only && start <= 0.0))
        return false;
    double at = start / (start - end);
    double tie = 64.0 * GEOM_ROUNDING;
    if (at > *nearest + tie || (at > *nearest - tie && !wins_tie(hit, t, start > 0.0)))
        return false;
    double weight[3];
    if (!segment_line_meets(segment, &octree->triangles[t], weight))
        return false;
    *nearest = at < *nearest ? at : *nearest;
    *hit = (struct octree_hit){t, start > 0.0, {weight[0], weight[1], weight[2]}};
    return true;
}

bool octree_first_hit(const struct octree *octree, struct vec3 origin, struct vec3 direction,
                      bool fronts_only, struct octree_hit *hit, struct octree_counts *counts)
{
    counts->rays++;
    struct vec3 end;
    if (octree->node_count == 0 || !clip_to_scene(&octree->nodes[0], &origin, direction, &end))
        return false;
    struct segment segment = segment_make(origin, end);
    struct probe probe = probe_make(origin, end);
    int flip = flip_of(direction);
    double nearest = 2.0;
    hit->triangle = -1;
    int32_t stack[STACK_SIZE];
    int height = 0;
    stack[height++] = 0;
    while (height > 0) {
        const struct node *node = &octree->nodes[stack[--height]];
        counts->node_tests++;
        if (!probe_meets_box(&probe, node))
            continue;
        if (node->count == 0) {
            height = push_children(node, flip, stack, height);
            continue;
        }
        bool improved = false;
        for (int32_t i = node->first; i < node->first + node->count; i++) {
            counts->triangle_tests++;
            improved |= improve_hit(octree, &segment, octree->order[i], fronts_only, &nearest, hit);
        }
        if (improved && nearest < 1.0) {
            double reach = nearest + 1e-9; /* boxes that begin behind the hit are of no use */
            struct vec3 span = vec3_sub(end, origin);
            probe = probe_make(origin, vec3_add(origin, vec3_scale(span, reach)));
        }
    }
    return hit->triangle >= 0;
}
