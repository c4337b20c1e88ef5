/* Building a tree.
 *
 * A triangle belongs to the one cell that holds its centroid, however far it sticks out, and the
 * box of a cell is the box of its triangles. So each triangle is recorded once, nothing can fall
 * between two cells, and the memory is known beforehand.
 *
 * The octants of a cell are not cubes: it is cut across z, the halves across y and the quarters
 * across x, each where that pays most. With the chance p_i that a line which meets a box meets
 * that of part i, the ratio of the boxes' areas, a cell that is cut costs sum p_i n_i triangle
 * tests, one that is not n. Cut through their middles, cells took a third more node and triangle
 * tests in furnished rooms; the longest axis first saved only 2 % more. Cells are split as long
 * as that saves more than the NODE_COST of looking at eight boxes. The queue of cells replaces
 * recursion. What lies in one point is cut by number below TREE_DEPTH.
 *
 * A record holds the triangle's affine maps in float, with a bound on their error: for |x| <= 1
 * each product and sum is off by at most 2^-24 of r1 = |r0| + |r1| + |r2| + |r3|, there are seven
 * of them, and coefficients and coordinates themselves are rounded: 10 x 2^-24 r1 in all. The
 * record says 16 x 2^-24 r1. Queries decide in float only what is beyond that. */
#include <math.h>
#include <stddef.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "octree/tree.h"

enum { BINS = 16 }; /* a cut is looked for at their edges */

static const double NODE_COST = 2.0;          /* of a node, in triangle tests */
static const double ERROR = 16.0 / 16777216.0; /* 16 x 2^-24 */
static const float NOWHERE = 1e9f;            /* middle of the box of an absent child */

struct box {
    struct vec3 low, high;
};

/* A cell that waits to be split or made a leaf. */
struct cell {
    int32_t begin, end, depth;
    int32_t node, octant; /* where it hangs */
};

struct builder {
    struct tree tree;
    const struct triangle *triangles;
    int32_t *order, *scratch;
    struct cell *queue;
    int64_t queue_count, queue_capacity;
};

static struct box box_of(const struct builder *builder, int32_t begin, int32_t end)
{
    struct vec3 low = builder->triangles[builder->order[begin]].corner[0], high = low;
    for (int32_t i = begin; i < end; i++) {
        for (int k = 0; k < 3; k++) {
            struct vec3 x = builder->triangles[builder->order[i]].corner[k];
            low = (struct vec3){real_min(low.x, x.x), real_min(low.y, x.y), real_min(low.z, x.z)};
            high = (struct vec3){real_max(high.x, x.x), real_max(high.y, x.y),
                                 real_max(high.z, x.z)};
        }
    }
    return (struct box){low, high};
}

static double box_area(struct box box)
{
    struct vec3 size = vec3_sub(box.high, box.low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

static double centroid_of(const struct builder *builder, int32_t i, int axis)
{
    return vec3_axis(triangle_centroid(&builder->triangles[builder->order[i]]), axis);
}

/* Triangles with their centroids in one slice, and the box around them. */
struct bin {
    struct box box;
    int32_t count;
};

static void bin_add(struct bin *bin, const struct bin *more)
{
    struct box a = bin->box, b = more->box;
    if (more->count == 0)
        return;
    if (bin->count > 0)
        b = (struct box){{real_min(a.low.x, b.low.x), real_min(a.low.y, b.low.y),
                          real_min(a.low.z, b.low.z)},
                         {real_max(a.high.x, b.high.x), real_max(a.high.y, b.high.y),
                          real_max(a.high.z, b.high.z)}};
    *bin = (struct bin){b, bin->count + more->count};
}

static double bin_cost(const struct bin *bin)
{
    return bin->count > 0 ? bin->count * box_area(bin->box) : 0.0;
}

/* Sorts what has its centroid between low and high, low < high, into bins. */
static void fill_bins(const struct builder *builder, int32_t begin, int32_t end, int axis,
                      double low, double high, struct bin bins[BINS])
{
    for (int32_t i = begin; i < end; i++) {
        int k = (int)(BINS * ((centroid_of(builder, i, axis) - low) / (high - low)));
        struct bin one = {box_of(builder, i, i + 1), 1};
        bin_add(&bins[k < BINS ? k : BINS - 1], &one);
    }
}

/* Where to cut a run across an axis: centroids below go to the first part. All do if they are in
 * one place. */
static double find_cut(const struct builder *builder, int32_t begin, int32_t end, int axis)
{
    double low = HUGE_VAL, high = -HUGE_VAL, left[BINS], least = HUGE_VAL;
    struct bin bins[BINS] = {{.count = 0}}, sum = {.count = 0};
    int best = BINS;
    for (int32_t i = begin; i < end; i++) {
        low = real_min(low, centroid_of(builder, i, axis));
        high = real_max(high, centroid_of(builder, i, axis));
    }
    if (!(high - low > GEOM_ROUNDING))
        return HUGE_VAL;
    fill_bins(builder, begin, end, axis, low, high, bins);
    for (int k = 0; k < BINS; k++) {
        left[k] = bin_cost(&sum);
        bin_add(&sum, &bins[k]);
    }
    sum.count = 0;
    for (int k = BINS - 1; k > 0; k--) {
        bin_add(&sum, &bins[k]);
        double cost = left[k] + bin_cost(&sum);
        if (cost < least) {
            least = cost;
            best = k;
        }
    }
    return low + (high - low) * best / BINS;
}

/* Cuts a run of `order`, keeping the order within each part. Returns where the second begins. */
static int32_t cut(struct builder *builder, int32_t begin, int32_t end, int axis)
{
    double at = find_cut(builder, begin, end, axis);
    int32_t middle = begin, above = 0;
    for (int32_t i = begin; i < end; i++)
        if (centroid_of(builder, i, axis) < at)
            builder->order[middle++] = builder->order[i];
        else
            builder->scratch[above++] = builder->order[i];
    for (int32_t i = 0; i < above; i++)
        builder->order[middle + i] = builder->scratch[i];
    return middle;
}

/* Sorts the cell's run of `order` by octant; octant k is then start[k] to start[k + 1]. */
static void sort_by_octant(struct builder *builder, const struct cell *cell,
                           int32_t start[LANES + 1])
{
    start[0] = cell->begin;
    start[LANES] = cell->end;
    for (int axis = 2, step = LANES; axis >= 0; axis--, step /= 2)
        for (int k = 0; k < LANES; k += step)
            start[k + step / 2] = cut(builder, start[k], start[k + step], axis);
}

/* True if splitting costs less than testing all triangles of the cell. */
static bool split_pays(const struct builder *builder, const struct cell *cell,
                       const int32_t start[LANES + 1])
{
    double whole = box_area(box_of(builder, cell->begin, cell->end)), cost = NODE_COST;
    for (int k = 0; k < LANES; k++)
        if (start[k] < start[k + 1])
            cost += box_area(box_of(builder, start[k], start[k + 1])) / whole *
                    (start[k + 1] - start[k]);
    return cost < cell->end - cell->begin;
}

/* Writes one axis of a child's box, middle and half rounded so that the box only grows. */
static void set_interval(float *middle, float *half, double low, double high)
{
    *middle = (float)(0.5 * (low + high));
    double reach = real_max(high - (double)*middle, (double)*middle - low);
    *half = (float)(reach * (1.0 + 1e-6) + 1e-30);
}

static int32_t append_node(struct builder *builder)
{
    struct tree *tree = &builder->tree;
    tree->nodes = alloc_reserve(tree->nodes, &tree->node_capacity, tree->node_count + 1,
                                sizeof *tree->nodes);
    struct node *node = &tree->nodes[tree->node_count];
    *node = (struct node){.child = {-1, -1, -1, -1, -1, -1, -1, -1}};
    for (int k = 0; k < LANES; k++)
        node->middle[0][k] = NOWHERE;
    return (int32_t)tree->node_count++;
}

static void append_cell(struct builder *builder, struct cell cell)
{
    builder->queue = alloc_reserve(builder->queue, &builder->queue_capacity,
                                   builder->queue_count + 1, sizeof *builder->queue);
    builder->queue[builder->queue_count++] = cell;
}

/* Hangs a new node below the cell's place and its non-empty octants below that. */
static int32_t split_cell(struct builder *builder, const struct cell *cell,
                          const int32_t start[LANES + 1])
{
    int32_t node = append_node(builder);
    for (int k = 0; k < LANES; k++) {
        if (start[k] == start[k + 1])
            continue;
        struct box box = box_of(builder, start[k], start[k + 1]);
        struct node *at = &builder->tree.nodes[node];
        set_interval(&at->middle[0][k], &at->half[0][k], box.low.x, box.high.x);
        set_interval(&at->middle[1][k], &at->half[1][k], box.low.y, box.high.y);
        set_interval(&at->middle[2][k], &at->half[2][k], box.low.z, box.high.z);
        append_cell(builder, (struct cell){start[k], start[k + 1], cell->depth + 1, node, k});
    }
    return node;
}

/* Eight parts of about the same number of triangles. */
static void cut_by_number(const struct cell *cell, int32_t start[LANES + 1])
{
    for (int k = 0; k <= LANES; k++)
        start[k] = cell->begin + (int32_t)((int64_t)(cell->end - cell->begin) * k / LANES);
}

static void process_cell(struct builder *builder, struct cell cell)
{
    int32_t count = cell.end - cell.begin, start[LANES + 1], child;
    bool is_root = cell.node < 0, splits = is_root || count > LEAF_MAX;
    if (cell.depth >= TREE_DEPTH) {
        cut_by_number(&cell, start);
    } else if (is_root || count > 1) {
        sort_by_octant(builder, &cell, start);
        splits = splits || split_pays(builder, &cell, start);
    }
    child = splits ? split_cell(builder, &cell, start) : ~(LEAF_MAX * cell.begin + count - 1);
    if (!is_root)
        builder->tree.nodes[cell.node].child[cell.octant] = child;
}

static void set_map(float map[4], float *error, struct vec3 gradient, double offset)
{
    double size = fabs(gradient.x) + fabs(gradient.y) + fabs(gradient.z) + fabs(offset);
    map[0] = (float)gradient.x;
    map[1] = (float)gradient.y;
    map[2] = (float)gradient.z;
    map[3] = (float)offset;
    *error = (float)(ERROR * size);
}

/* The maps of the barycentric coordinates: u = (x - a) . (e2 x n) / n^2, v = (x - a) . (n x e1) /
 * n^2 with n = e1 x e2, e1 = b - a, e2 = c - a. */
static struct record make_record(const struct triangle *t, const struct plane *plane,
                                 int32_t number)
{
    struct vec3 a = t->corner[0];
    struct vec3 e1 = vec3_sub(t->corner[1], a), e2 = vec3_sub(t->corner[2], a);
    struct vec3 n = vec3_cross(e1, e2);
    double scale = 1.0 / vec3_dot(n, n);
    struct vec3 u = vec3_scale(vec3_cross(e2, n), scale);
    struct vec3 v = vec3_scale(vec3_cross(n, e1), scale);
    struct record record = {.triangle = number};
    set_map(record.u, &record.error_u, u, -vec3_dot(u, a));
    set_map(record.v, &record.error_v, v, -vec3_dot(v, a));
    set_map(record.w, &record.error_w, plane->normal, -plane->offset);
    return record;
}

struct tree tree_build(const struct triangle *triangles, const struct plane *planes, int32_t *order,
                       int32_t count)
{
    struct builder builder = {.triangles = triangles, .order = order};
    if (count == 0)
        return builder.tree;
    if (count > INT32_MAX / LEAF_MAX)
        alloc_fail((size_t)count * sizeof(struct record)); /* no child could say where it is */
    builder.scratch = alloc_array((size_t)count, sizeof *builder.scratch);
    struct box box = box_of(&builder, 0, count);
    append_cell(&builder, (struct cell){.end = count, .node = -1});
    for (int64_t at = 0; at < builder.queue_count && !stop_is_asked(); at++)
        process_cell(&builder, builder.queue[at]);
    struct tree *tree = &builder.tree;
    tree->low = box.low;
    tree->high = box.high;
    tree->record_count = count;
    tree->records = alloc_array((size_t)count, sizeof *tree->records);
    for (int32_t i = 0; i < count; i++)
        tree->records[i] = make_record(&triangles[order[i]], &planes[order[i]], order[i]);
    alloc_free(builder.scratch);
    alloc_free(builder.queue);
    return builder.tree;
}

void tree_free(struct tree *tree)
{
    alloc_free(tree->nodes);
    alloc_free(tree->records);
    *tree = (struct tree){0};
}

void tree_pack_arrays(struct tree *tree, struct pack *pack)
{
    tree->node_capacity = tree->node_count;
    tree->nodes = pack_array(pack, tree->nodes, (size_t)tree->node_count * sizeof *tree->nodes);
    tree->records = pack_array(pack, tree->records,
                               (size_t)tree->record_count * sizeof *tree->records);
}

/* Largest signed distance to the plane of a point of child k's box. */
static double box_reach(const struct node *node, int k, const struct plane *plane)
{
    struct vec3 middle = {(double)node->middle[0][k], (double)node->middle[1][k],
                          (double)node->middle[2][k]};
    struct vec3 n = plane->normal;
    return plane_distance(plane, middle) + fabs(n.x) * (double)node->half[0][k] +
           fabs(n.y) * (double)node->half[1][k] + fabs(n.z) * (double)node->half[2][k];
}

bool tree_reaches_above(const struct tree *tree, const struct triangle *triangles,
                        const struct plane *plane, double margin)
{
    int32_t stack[TREE_STACK];
    int height = 0;
    if (tree->node_count > 0)
        stack[height++] = 0;
    while (height > 0) {
        int32_t at = stack[--height];
        if (at >= 0) {
            const struct node *node = &tree->nodes[at];
            for (int k = 0; k < LANES; k++)
                if (node->middle[0][k] < NOWHERE && box_reach(node, k, plane) > margin)
                    stack[height++] = node->child[k];
            continue;
        }
        struct leaf leaf = leaf_of(at);
        for (int32_t i = leaf.first; i < leaf.first + leaf.count; i++)
            for (int k = 0; k < 3; k++)
                if (plane_distance(plane, triangles[tree->records[i].triangle].corner[k]) > margin)
                    return true;
    }
    return false;
}
