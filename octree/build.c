/* Building a tree.
 *
 * A triangle belongs to the one cell that holds the middle of its box, however far it
 * sticks out, and the box of a cell is the box of its triangles. So each triangle is
 * recorded once, nothing can fall between two cells, and the memory is known beforehand.
 *
 * The eight parts of a cell are not cubes. A line through the cell's box meets the box of
 * part i with the chance p_i, the ratio of the boxes' areas: a cut cell costs sum p_i n_i
 * triangle tests, an uncut one n. As long as there are fewer than eight parts, the one
 * with the largest box is cut in two, across the axis and at the place of the least sum.
 * Cells are split as long as the saving exceeds the NODE_COST of looking at eight boxes.
 * Each part then takes the octant in its direction, the farthest out first: a ray goes
 * through octants from the nearest to the farthest. The queue of cells replaces
 * recursion. Triangles whose boxes have one middle are cut by number.
 *
 * Rejected (tests/bench/hits.c, rooms of 6,348 and 31,936 triangles): across z, the
 * halves across y and the quarters across x, each at its best place, cells have 5.9 parts
 * and not 7, and first hits look at 10.9 and 15.0 nodes and 7.1 and 7.9 triangles,
 * instead of 7.7 and 9.3 nodes and 5.2 and 6.5 triangles. Cutting the part with most
 * triangles times area, or sorting children by distance for each ray, saves nothing more.
 *
 * A record holds the triangle's affine maps in float, with a bound on their error: for
 * |x| <= 1 each product and sum is off by at most 2^-24 of r1 = |r0| + |r1| + |r2| +
 * |r3|, there are seven of them, and coefficients and coordinates themselves are rounded:
 * 10 x 2^-24 r1 in all. The record says 16 x 2^-24 r1. Queries decide in float only
 * beyond this bound. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/stop.h"
#include "octree/tree.h"

enum { BINS = 16 }; /* at most; a cut is looked for at their edges */

static const float NODE_COST = 2.0f;           /* of a node, in triangle tests */
static const double ERROR = 16.0 / 16777216.0; /* 16 x 2^-24 */
static const float NOWHERE = 1e9f; /* low side of the box of an absent child */

struct box {
    float low[3], high[3];
};

/* A triangle on its way into a cell. */
struct item {
    struct box box;
    int32_t triangle;
};

/* A run of items. */
struct part {
    int32_t begin, end;
    struct box box;
    bool is_whole; /* cannot be cut */
};

/* A cell waiting to be split or made a leaf. */
struct cell {
    struct part part;
    int32_t depth;
    int32_t node, octant; /* where it hangs */
};

struct builder {
    struct tree tree;
    struct item *items, *scratch;
    struct cell *queue;
    int64_t queue_count, queue_capacity;
};

/* --- boxes --- */

static const struct box NO_BOX = {{HUGE_VALF, HUGE_VALF, HUGE_VALF},
                                  {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}};

static void box_add(struct box *box, const struct box *more)
{
    for (int k = 0; k < 3; k++) {
        box->low[k] = more->low[k] < box->low[k] ? more->low[k] : box->low[k];
        box->high[k] = more->high[k] > box->high[k] ? more->high[k] : box->high[k];
    }
}

static float box_area(const struct box *box)
{
    float x = box->high[0] - box->low[0], y = box->high[1] - box->low[1];
    float z = box->high[2] - box->low[2];
    return x * y + y * z + z * x;
}

/* Twice its middle. */
static float box_middle(const struct box *box, int axis)
{
    return box->low[axis] + box->high[axis];
}

/* The greatest float not above x, or a few before it. */
static float round_down(double x)
{
    return (float)(x - fabs(x) * 1.2e-7 - 1e-30);
}

static struct box triangle_box(const struct triangle *t)
{
    struct box box;
    for (int k = 0; k < 3; k++) {
        double a = vec3_axis(t->corner[0], k), b = vec3_axis(t->corner[1], k);
        double c = vec3_axis(t->corner[2], k);
        box.low[k] = round_down(real_min(a, real_min(b, c)));
        box.high[k] = -round_down(-real_max(a, real_max(b, c)));
    }
    return box;
}

/* --- cutting --- */

/* A way to cut a run in two: items below `bin` go to the first part. */
struct cutting {
    int axis, bin, bins;
    float low, scale; /* bins begin at `low`; bins per unit of length */
    float cost;
};

static int bin_of(const struct cutting *cutting, const struct item *item)
{
    int bin =
        (int)((box_middle(&item->box, cutting->axis) - cutting->low) * cutting->scale);
    return bin < cutting->bins ? bin : cutting->bins - 1;
}

/* Items with their middles in one slice, and the box around them. */
struct bin {
    struct box box;
    int32_t count;
};

static void bin_add(struct bin *bin, const struct bin *more)
{
    box_add(&bin->box, &more->box);
    bin->count += more->count;
}

static float bin_cost(const struct bin *bin)
{
    return bin->count > 0 ? (float)bin->count * box_area(&bin->box) : 0.0f;
}

/* Looks for a cut along the axis of `trial` better than the best so far. */
static void improve_cutting(struct cutting *best, struct cutting trial,
                            const struct item *items, int32_t count)
{
    struct bin bins[BINS], sum = {NO_BOX, 0};
    float left[BINS];
    for (int k = 0; k < trial.bins; k++)
        bins[k] = sum;
    for (int32_t i = 0; i < count; i++) {
        struct bin *bin = &bins[bin_of(&trial, &items[i])];
        box_add(&bin->box, &items[i].box);
        bin->count++;
    }
    for (int k = 0; k < trial.bins; k++) {
        left[k] = bin_cost(&sum);
        bin_add(&sum, &bins[k]);
    }
    sum = (struct bin){NO_BOX, 0};
    for (trial.bin = trial.bins - 1; trial.bin > 0; trial.bin--) {
        bin_add(&sum, &bins[trial.bin]);
        trial.cost = left[trial.bin] + bin_cost(&sum);
        if (trial.cost < best->cost)
            *best = trial;
    }
}

/* The best cut; its cost is infinite if all middles are in one place. */
static struct cutting find_cutting(const struct item *items, int32_t count)
{
    struct cutting best = {.cost = HUGE_VALF};
    struct box middles = NO_BOX;
    for (int32_t i = 0; i < count; i++) {
        struct box point;
        for (int k = 0; k < 3; k++)
            point.low[k] = point.high[k] = box_middle(&items[i].box, k);
        box_add(&middles, &point);
    }
    for (int k = 0; k < 3; k++) {
        float size = middles.high[k] - middles.low[k];
        struct cutting trial = {.axis = k, .bins = count < BINS ? count : BINS,
                                .low = middles.low[k]};
        trial.scale = (float)trial.bins / size;
        if (size > 1e-12f)
            improve_cutting(&best, trial, items, count);
    }
    return best;
}

static struct box box_around(const struct item *items, int32_t begin, int32_t end)
{
    struct box box = NO_BOX;
    for (int32_t i = begin; i < end; i++)
        box_add(&box, &items[i].box);
    return box;
}

static struct part part_of(const struct builder *builder, int32_t begin, int32_t end)
{
    return (struct part){begin, end, box_around(builder->items, begin, end), false};
}

/* Cuts a part, keeping the order within both; the second becomes `rest`. Returns false,
 * and marks the part, if no cut is possible. */
static bool cut_part(struct builder *builder, struct part *part, struct part *rest)
{
    struct item *items = builder->items;
    int32_t middle = part->begin, above = 0;
    struct cutting cutting = find_cutting(items + part->begin, part->end - part->begin);
    part->is_whole = !(cutting.cost < HUGE_VALF);
    if (part->is_whole)
        return false;
    for (int32_t i = part->begin; i < part->end; i++)
        if (bin_of(&cutting, &items[i]) < cutting.bin)
            items[middle++] = items[i];
        else
            builder->scratch[above++] = items[i];
    memcpy(items + middle, builder->scratch, (size_t)above * sizeof *items);
    *rest = part_of(builder, middle, part->end);
    *part = part_of(builder, part->begin, middle);
    return true;
}

/* Of the parts left to cut the one with the largest box, or -1. */
static int largest_part(const struct part *parts, int count)
{
    int largest = -1;
    float most = -1.0f;
    for (int k = 0; k < count; k++) {
        float area = box_area(&parts[k].box);
        if (!parts[k].is_whole && parts[k].end - parts[k].begin > 1 && area > most) {
            largest = k;
            most = area;
        }
    }
    return largest;
}

/* Eight parts of about the same number of triangles. */
static void cut_by_number(const struct builder *builder, const struct part *whole,
                          struct part parts[LANES])
{
    int64_t size = whole->end - whole->begin;
    for (int k = 0; k < LANES; k++)
        parts[k] = part_of(builder, whole->begin + (int32_t)(size * k / LANES),
                           whole->begin + (int32_t)(size * (k + 1) / LANES));
}

/* Cuts a cell. Returns the number of parts: 1 if it is cut by number only when it has to
 * be. */
static int cut_cell(struct builder *builder, const struct cell *cell,
                    struct part parts[LANES])
{
    int count = 1;
    parts[0] = cell->part;
    for (int k; cell->depth < TREE_DEPTH && count < LANES; )
        if ((k = largest_part(parts, count)) < 0)
            break;
        else
            count += cut_part(builder, &parts[k], &parts[count]);
    if (count > 1 || cell->part.end - cell->part.begin <= LEAF_MAX)
        return count;
    cut_by_number(builder, &cell->part, parts);
    return LANES;
}

/* True if splitting costs less than testing all triangles of the cell. */
static bool split_pays(const struct part *whole, const struct part *parts, int count)
{
    float cost = (NODE_COST - (float)(whole->end - whole->begin)) * box_area(&whole->box);
    for (int k = 0; k < count; k++)
        cost += (float)(parts[k].end - parts[k].begin) * box_area(&parts[k].box);
    return cost < 0.0f;
}

/* --- nodes --- */

static int32_t append_node(struct builder *builder)
{
    struct tree *tree = &builder->tree;
    RESERVE(tree->nodes, &tree->node_capacity, tree->node_count + 1);
    struct node *node = &tree->nodes[tree->node_count];
    *node = (struct node){.child = {-1, -1, -1, -1, -1, -1, -1, -1}};
    for (int k = 0; k < LANES; k++)
        for (int axis = 0; axis < 3; axis++) {
            node->bound[axis][0][k] = NOWHERE;
            node->bound[axis][1][k] = -NOWHERE;
        }
    return (int32_t)tree->node_count++;
}

static void append_cell(struct builder *builder, struct cell cell)
{
    RESERVE(builder->queue, &builder->queue_capacity, builder->queue_count + 1);
    builder->queue[builder->queue_count++] = cell;
}

/* Which octant each part takes: of all pairs left always the one with the part farthest
 * out. */
static void assign_octants(const struct part *whole, const struct part *parts, int count,
                           int octants[LANES])
{
    float out[LANES][LANES];
    unsigned taken = 0, placed = 0;
    for (int k = 0; k < count; k++)
        for (int octant = 0; octant < LANES; octant++) {
            out[k][octant] = 0.0f;
            for (int axis = 0; axis < 3; axis++) {
                float d = box_middle(&parts[k].box, axis) - box_middle(&whole->box, axis);
                out[k][octant] += octant >> axis & 1 ? d : -d;
            }
        }
    for (int round = 0; round < count; round++) {
        int part = -1, place = -1;
        for (int k = 0; k < count; k++)
            for (int octant = 0; octant < LANES && !(placed >> k & 1u); octant++)
                if (!(taken >> octant & 1u) &&
                    (part < 0 || out[k][octant] > out[part][place])) {
                    part = k;
                    place = octant;
                }
        octants[part] = place;
        placed |= 1u << part;
        taken |= 1u << place;
    }
}

/* Hangs a new node below the cell's place, and the parts below the node. */
static int32_t split_cell(struct builder *builder, const struct cell *cell,
                          const struct part *parts, int count)
{
    int32_t number = append_node(builder);
    struct node *node = &builder->tree.nodes[number];
    int octants[LANES];
    assign_octants(&cell->part, parts, count, octants);
    for (int k = 0; k < count; k++) {
        for (int axis = 0; axis < 3; axis++) {
            node->bound[axis][0][octants[k]] = parts[k].box.low[axis] - BOX_MARGIN;
            node->bound[axis][1][octants[k]] = parts[k].box.high[axis] + BOX_MARGIN;
        }
        append_cell(builder,
                    (struct cell){parts[k], cell->depth + 1, number, octants[k]});
    }
    return number;
}

static void process_cell(struct builder *builder, struct cell cell)
{
    struct part parts[LANES];
    int32_t count = cell.part.end - cell.part.begin;
    bool is_root = cell.node < 0, splits = is_root || count > LEAF_MAX;
    int part_count =
        splits || (float)count > NODE_COST ? cut_cell(builder, &cell, parts) : 1;
    splits = splits || (part_count > 1 && split_pays(&cell.part, parts, part_count));
    int32_t child = splits ? split_cell(builder, &cell, parts, part_count)
                           : ~(LEAF_MAX * cell.part.begin + count - 1);
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

/* The maps of the barycentric coordinates: u = (x - a) . (e2 x n) / n^2, v = (x - a) . (n
 * x e1) / n^2 with n = e1 x e2, e1 = b - a, e2 = c - a. */
static struct record make_record(const struct triangle *t, const struct plane *plane,
                                 int32_t number)
{
    struct vec3 a = t->corner[0];
    struct vec3 e1 = vec3_sub(t->corner[1], a), e2 = vec3_sub(t->corner[2], a);
    struct vec3 n = vec3_cross(e1, e2);
    double scale = 1.0 / vec3_dot(n, n);
    struct vec3 u = vec3_scale(vec3_cross(e2, n), scale);
    struct vec3 v = vec3_scale(vec3_cross(n, e1), scale);
    struct record record = {.plane = *plane, .triangle = number};
    float w[4]; /* only its error is kept */
    set_map(record.u, &record.error_u, u, -vec3_dot(u, a));
    set_map(record.v, &record.error_v, v, -vec3_dot(v, a));
    set_map(w, &record.error_w, plane->normal, -plane->offset);
    return record;
}

struct tree tree_build(const struct triangle *triangles, const struct plane *planes,
                       const int32_t *order, int32_t count)
{
    struct builder builder = {.queue_count = 0};
    struct tree *tree = &builder.tree;
    if (count == 0)
        return *tree;
    if (count > INT32_MAX / LEAF_MAX)
        alloc_fail((size_t)count *
                   sizeof(struct record)); /* no child could tell a record's place */
    builder.items = alloc_array((size_t)count, sizeof *builder.items);
    builder.scratch = alloc_array((size_t)count, sizeof *builder.scratch);
    for (int32_t i = 0; i < count; i++)
        builder.items[i] = (struct item){triangle_box(&triangles[order[i]]), order[i]};
    append_cell(&builder, (struct cell){.part = part_of(&builder, 0, count), .node = -1});
    for (int64_t at = 0; at < builder.queue_count && !stop_is_asked(); at++)
        process_cell(&builder, builder.queue[at]);
    tree->record_count = count;
    tree->records = alloc_array((size_t)count, sizeof *tree->records);
    for (int32_t i = 0; i < count; i++) {
        int32_t t = builder.items[i].triangle;
        tree->records[i] = make_record(&triangles[t], &planes[t], t);
    }
    alloc_free(builder.items);
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
    PACK(pack, tree->nodes, tree->node_count);
    PACK(pack, tree->records, tree->record_count);
}
