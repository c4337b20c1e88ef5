/* A loose octree that answers for 16 segments at a time.
 *
 *     cell (space)          what is stored
 *     +-----+-----+         node: eight boxes side by side, each the box of all
 *     |  /\ |     |           triangles below that octant, not of the octant
 *     | /__\|_____|         leaf: a run of records of 80 bytes
 *     |   \ | /\  |         record: a triangle's plane, two affine maps in float
 *     +-----+-----+
 *
 * A bundle goes down as a whole. A box is compared with the shaft of its eight end points by
 * separating axes: the three of the box, and the cross products of each with the direction of
 * the shaft. No division, so nothing special happens in axis planes. Eight boxes are one vector
 * of lanes, so a node costs about as much as one box.
 *
 * A triangle sees the bundle as 4 + 4 points, which again are eight lanes: the signed distances
 * w to its plane, and if they are not all on one side, its barycentric coordinates u and v. If all
 * eight points are on the far side of an edge no segment meets it. Only then are the 16 pairs
 * looked at, in two vectors: from w, u at one end and w', u' at the other, the crossing point has
 * u = (u w' - u' w) / (w' - w), and only signs matter.
 *
 * All of this is float, and every comparison keeps a margin for its rounding. A pair for which
 * the signs are not certain, near an edge or where an end point lies in the plane, is decided by
 * segment_is_blocked_by() in double. So float decides nothing that double would decide
 * otherwise, and the answers are the watertight ones of geom/triangle.c to the bit.
 *
 * Triangles that have the whole scene on one side, the walls of a room, can block nothing between
 * two of its points. They are in a tree of their own that only cameras look at.
 *
 * Measured with tests/bench/rays.c on rooms of 6,348 and 31,936 triangles, built by default for
 * x86-64, as multiples of Embree's best packets of 16, which use AVX-512: in refinement order 0.58
 * and 0.48, in random order 0.59 and 0.44; one by one Embree has 0.4 to 0.8 of these speeds. What
 * made bundles faster, most of all first: a link starts with the last blocker of the one that it
 * comes from; tests inlined, masks folded in whole words; the six slabs of a node written out
 * instead of looped over; boxes by their sides and cells with more parts (octree/build.c); numbers
 * of the shaft spread over the lanes once, not for each node; two nodes at a time, so that their
 * latencies overlap. Eight-lane vectors where registers have four lanes had 0.4 of the speed of
 * twice four. Remembering two to six blockers instead of one, fetching the next node ahead, pushing
 * children without branches, and splitting cells more or less eagerly gained nothing. */
#include "octree/octree.h"

#include <stddef.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/hull.h"
#include "geom/stop.h"
#include "geom/wall.h"
#include "octree/tree.h"

/* True if no corner of the scene is in front of the plane, or none behind it. */
static bool is_on_hull(const struct tree *all, const struct triangle *triangles, struct plane plane)
{
    struct plane back = {vec3_scale(plane.normal, -1.0), -plane.offset};
    return !tree_reaches_above(all, triangles, &plane, 0.5 * GEOM_ROUNDING) ||
           !tree_reaches_above(all, triangles, &back, 0.5 * GEOM_ROUNDING);
}

/* The ball around the triangles in `order`; around none it is no ball, and rays miss it. */
static void set_ball(struct octree *octree, const int32_t *order, int32_t count)
{
    struct vec3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = vec3_scale(low, -1.0);
    for (int32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 x = octree->triangles[order[i]].corner[k];
            low = (struct vec3){real_min(low.x, x.x), real_min(low.y, x.y), real_min(low.z, x.z)};
            high = (struct vec3){real_max(high.x, x.x), real_max(high.y, x.y),
                                 real_max(high.z, x.z)};
        }
    octree->middle = vec3_middle(low, high);
    octree->radius = 0.5 * vec3_length(vec3_sub(high, low)) * 1.0001 + GEOM_ROUNDING;
}

/* Builds the trees over the `kept` triangles in `order`. */
static void plant_trees(struct octree *octree, const int32_t *order, int32_t kept)
{
    int32_t *inside = alloc_array((size_t)kept, sizeof *inside);
    int32_t *hull = alloc_array((size_t)kept, sizeof *hull);
    int32_t inside_count = 0, hull_count = 0;
    struct tree all = tree_build(octree->triangles, octree->planes, order, kept);
    for (int32_t i = 0; i < kept && !stop_is_asked(); i++) {
        int32_t t = order[i];
        if (is_on_hull(&all, octree->triangles, octree->planes[t]))
            hull[hull_count++] = t;
        else
            inside[inside_count++] = t;
    }
    tree_free(&all);
    octree->inside = tree_build(octree->triangles, octree->planes, inside, inside_count);
    octree->hull = tree_build(octree->triangles, octree->planes, hull, hull_count);
    alloc_free(inside);
    alloc_free(hull);
}

struct octree *octree_create(const struct triangle *triangles, const struct plane *planes,
                             int32_t count)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    octree->triangles = triangles;
    octree->planes = planes;
    octree->count = count;
    int32_t *order = alloc_array((size_t)count, sizeof *order);
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++)
        if (vec3_dot(planes[i].normal, planes[i].normal) > 0.0)
            order[kept++] = i;
    set_ball(octree, order, kept);
    plant_trees(octree, order, kept);
    alloc_free(order);
    octree->neighbours = walls_find_neighbours(triangles, planes, count);
    octree->place = alloc_array((size_t)count, sizeof *octree->place);
    for (int32_t i = 0; i < count; i++)
        octree->place[i] = -1;
    for (int64_t i = 0; i < octree->inside.record_count; i++)
        octree->place[octree->inside.records[i].triangle] = (int32_t)i;
    return octree;
}

void octree_destroy(struct octree *octree)
{
    if (!octree)
        return;
    if (!octree->is_view) {
        tree_free(&octree->inside);
        tree_free(&octree->hull);
        alloc_free(octree->place);
        alloc_free(octree->neighbours);
    }
    alloc_free(octree);
}

static void pack_arrays(struct octree *octree, struct pack *pack)
{
    tree_pack_arrays(&octree->inside, pack);
    tree_pack_arrays(&octree->hull, pack);
    octree->place = pack_array(pack, octree->place, (size_t)octree->count * sizeof *octree->place);
    size_t bytes = 3 * (size_t)octree->count * sizeof *octree->neighbours;
    octree->neighbours = pack_array(pack, octree->neighbours, bytes);
}

void octree_pack(const struct octree *octree, struct pack *pack)
{
    struct octree view = *octree;
    view.is_view = true;
    pack_array(pack, &view, sizeof view);
    pack_arrays(&view, pack);
}

struct octree *octree_view(struct pack *pack, const struct triangle *triangles,
                           const struct plane *planes)
{
    struct octree *octree = alloc_array(1, sizeof *octree);
    memcpy(octree, pack_array(pack, NULL, sizeof *octree), sizeof *octree);
    octree->triangles = triangles;
    octree->planes = planes;
    pack_arrays(octree, pack);
    return octree;
}

static int64_t tree_bytes(const struct tree *tree)
{
    return tree->node_capacity * (int64_t)sizeof *tree->nodes +
           tree->record_count * (int64_t)sizeof *tree->records;
}

int64_t octree_bytes(const struct octree *octree)
{
    return tree_bytes(&octree->inside) + tree_bytes(&octree->hull) +
           octree->count * (int64_t)sizeof *octree->place +
           3 * octree->count * (int64_t)sizeof *octree->neighbours;
}

/* --- walking down with a shaft --- */

/* A slab of the shaft: the points x with low <= n . x <= high hold all end points. */
struct slab {
    lanes low, high; /* the same in all lanes */
};

struct shaft {
    lanes points[3];          /* coordinates of the four starts, then of the four ends */
    struct slab own[3];       /* n = x, y, z */
    struct slab cross[3];     /* n = direction x (x, y, z axis) */
    lanes direction[3];       /* from the middle of the starts to that of the ends, largest |.| 1 */
    int flip;                 /* bits of the axes along which it runs downwards */
};

static struct slab slab_of(const float values[LANES])
{
    float low = values[0], high = values[0];
    for (int k = 1; k < LANES; k++) {
        low = values[k] < low ? values[k] : low;
        high = values[k] > high ? values[k] : high;
    }
    return (struct slab){lanes_all(low - BOX_MARGIN), lanes_all(high + BOX_MARGIN)};
}

static void shaft_set_points(struct shaft *shaft, const struct vec3 from[BUNDLE_ENDS],
                             const struct vec3 to[BUNDLE_ENDS])
{
    float points[3][LANES];
    for (int k = 0; k < LANES; k++) {
        struct vec3 x = k < BUNDLE_ENDS ? from[k] : to[k - BUNDLE_ENDS];
        points[0][k] = (float)x.x;
        points[1][k] = (float)x.y;
        points[2][k] = (float)x.z;
    }
    for (int axis = 0; axis < 3; axis++)
        shaft->points[axis] = lanes_at(points[axis]);
}

/* The rest, which only a walk needs: direction and slabs of the points. */
static void shaft_set_slabs(struct shaft *shaft)
{
    float points[3][LANES], direction[3], largest = 1e-30f;
    memcpy(points, shaft->points, sizeof points);
    shaft->flip = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float *p = points[axis];
        float d = ((p[4] - p[0]) + (p[5] - p[1])) + ((p[6] - p[2]) + (p[7] - p[3]));
        direction[axis] = d;
        shaft->flip |= (d < 0.0f) << axis;
        largest = fabsf(d) > largest ? fabsf(d) : largest;
    }
    for (int axis = 0; axis < 3; axis++)
        direction[axis] /= largest;
    for (int axis = 0; axis < 3; axis++) {
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        float across[LANES];
        for (int k = 0; k < LANES; k++)
            across[k] = direction[j] * points[i][k] - direction[i] * points[j][k];
        shaft->own[axis] = slab_of(points[axis]);
        shaft->cross[axis] = slab_of(across);
        shaft->direction[axis] = lanes_all(direction[axis]);
    }
}

static void shaft_set(struct shaft *shaft, const struct vec3 from[BUNDLE_ENDS],
                      const struct vec3 to[BUNDLE_ENDS])
{
    shaft_set_points(shaft, from, to);
    shaft_set_slabs(shaft);
}

/* Boxes beyond the slab of an axis. */
#define OUT_OF_OWN(axis)                                                                    \
    mask_or(lanes_above(lanes_at(node->bound[axis][0]), shaft->own[axis].high),             \
            lanes_above(shaft->own[axis].low, lanes_at(node->bound[axis][1])))

/* direction[j] x_i is largest on one side of a box, and smallest on the other. */
#define MOST(i, j) lanes_mul(shaft->direction[j], lanes_at(node->bound[i][up##j]))
#define LEAST(i, j) lanes_mul(shaft->direction[j], lanes_at(node->bound[i][!up##j]))

/* Boxes beyond the slab of an axis's cross product with the direction, which lies across the axes
 * i and j. */
#define OUT_OF_CROSS(axis, i, j)                                                            \
    mask_or(lanes_above(lanes_sub(LEAST(i, j), MOST(j, i)), shaft->cross[axis].high),       \
            lanes_above(shaft->cross[axis].low, lanes_sub(MOST(i, j), LEAST(j, i))))

/* Children of a node whose boxes the shaft may meet, a bit for each. */
INLINE unsigned children_met(const struct node *node, const struct shaft *shaft)
{
    int up0 = ~shaft->flip & 1, up1 = ~shaft->flip >> 1 & 1, up2 = ~shaft->flip >> 2 & 1;
    lanes_mask own = mask_or(OUT_OF_OWN(0), mask_or(OUT_OF_OWN(1), OUT_OF_OWN(2)));
    lanes_mask cross = mask_or(OUT_OF_CROSS(0, 1, 2),
                               mask_or(OUT_OF_CROSS(1, 2, 0), OUT_OF_CROSS(2, 0, 1)));
    lanes_mask out = mask_or(own, cross);
    return ~mask_bits(&out) & 0xffu;
}

/* Puts the children that are met on the stack, the nearest on top. Returns the new height. */
INLINE int push_children(const struct node *node, unsigned met, const struct shaft *shaft,
                         int32_t *stack, int height)
{
    int far = shaft->flip ^ 7; /* the farthest octant; bit k is to be that of octant k ^ far */
    if (far & 1)
        met = (met & 0x55u) << 1 | (met & 0xaau) >> 1;
    if (far & 2)
        met = (met & 0x33u) << 2 | (met & 0xccu) >> 2;
    if (far & 4)
        met = (met & 0x0fu) << 4 | met >> 4;
    for (; met != 0; met &= met - 1)
        stack[height++] = node->child[lowest_bit(met) ^ far];
    return height;
}

/* Takes the topmost node off the stack, and the one below if that is an inner node too, and puts
 * their children on it. A node is a long chain of operations, each waiting for the one before:
 * two at a time take little longer than one. On the stack depths do not decrease upwards, so
 * there are never more than 16 entries of one depth. */
INLINE int descend(const struct tree *tree, const struct shaft *shaft, int32_t *stack, int height,
                   struct octree_counts *counts)
{
    const struct node *top = &tree->nodes[stack[--height]];
    counts->node_tests++;
    if (height == 0 || stack[height - 1] < 0)
        return push_children(top, children_met(top, shaft), shaft, stack, height);
    const struct node *below = &tree->nodes[stack[--height]];
    counts->node_tests++;
    unsigned met_below = children_met(below, shaft), met_top = children_met(top, shaft);
    height = push_children(below, met_below, shaft, stack, height);
    return push_children(top, met_top, shaft, stack, height);
}

/* --- a triangle against a bundle --- */

/* An affine map at eight points. */
#define MAP(r, p)                                                                          \
    lanes_add(lanes_add(lanes_mul(lanes_all((r)[0]), (p)[0]),                              \
                        lanes_mul(lanes_all((r)[1]), (p)[1])),                             \
              lanes_add(lanes_mul(lanes_all((r)[2]), (p)[2]), lanes_all((r)[3])))

/* What float knows of the pairs and a triangle. */
struct verdict {
    unsigned hit, miss; /* bits of the pairs for which it is certain */
};

/* Eight pairs. With s = w' - w, the crossing point has u = U / s, v = V / s; it is inside if U, V
 * and s - U - V have the sign of s. The margins follow from the errors of the maps. */
INLINE struct verdict judge_half(const struct record *r, const lanes *u0, const lanes *u1,
                                 const lanes *v0, const lanes *v1, const lanes *w0, const lanes *w1)
{
    lanes eu = lanes_all(r->error_u), ev = lanes_all(r->error_v), ew = lanes_all(r->error_w);
    lanes zero = lanes_all(0.0f);
    lanes s = lanes_sub(*w1, *w0), size = lanes_abs(s);
    lanes u = lanes_flip(lanes_sub(lanes_mul(*u0, *w1), lanes_mul(*u1, *w0)), s);
    lanes v = lanes_flip(lanes_sub(lanes_mul(*v0, *w1), lanes_mul(*v1, *w0)), s);
    lanes third = lanes_sub(size, lanes_add(u, v));
    lanes far = lanes_add(lanes_abs(*w0), lanes_abs(*w1));
    lanes mu = lanes_add(lanes_mul(eu, far),
                         lanes_mul(ew, lanes_add(lanes_abs(*u0), lanes_abs(*u1))));
    lanes mv = lanes_add(lanes_mul(ev, far),
                         lanes_mul(ew, lanes_add(lanes_abs(*v0), lanes_abs(*v1))));
    lanes ms = lanes_add(lanes_add(mu, mv), lanes_mul(lanes_all(3.0f), ew));
    lanes nw = lanes_sub(zero, ew);
    lanes_mask up = mask_and(lanes_above(*w0, ew), lanes_above(nw, *w1));
    lanes_mask down = mask_and(lanes_above(*w1, ew), lanes_above(nw, *w0));
    lanes_mask above = mask_and(lanes_above(*w0, ew), lanes_above(*w1, ew));
    lanes_mask below = mask_and(lanes_above(nw, *w0), lanes_above(nw, *w1));
    lanes_mask inside = mask_and(mask_and(lanes_above(u, mu), lanes_above(v, mv)),
                                 lanes_above(third, ms));
    lanes_mask outside = mask_or(mask_or(lanes_above(lanes_sub(zero, mu), u),
                                         lanes_above(lanes_sub(zero, mv), v)),
                                 lanes_above(lanes_sub(zero, ms), third));
    lanes_mask sure = lanes_above(size, lanes_mul(lanes_all(3.0f), ew));
    lanes_mask hit = mask_and(mask_or(up, down), inside);
    lanes_mask miss = mask_or(mask_or(above, below), mask_and(outside, sure));
    return (struct verdict){mask_bits(&hit), mask_bits(&miss)};
}

/* 1 if a > b in all lanes. Results are joined by | and not ||: one branch that is hard to guess
 * costs more than a few operations. */
INLINE int all_above(const lanes *a, const lanes *b)
{
    lanes_mask mask = lanes_above(*a, *b);
    return mask_is_full(&mask);
}

/* Looks at the eight points, then at the 16 pairs. What is in neither set has to be decided in
 * double. */
INLINE struct verdict judge(const struct record *r, const struct shaft *shaft, unsigned wanted)
{
    const struct verdict none = {0, 0xffffu};
    const lanes *p = shaft->points;
    lanes zero = lanes_all(0.0f);
    struct vec3 n = r->plane.normal;
    const float distance[4] = {(float)n.x, (float)n.y, (float)n.z, -(float)r->plane.offset};
    lanes w = MAP(distance, p), ew = lanes_all(r->error_w), nw = lanes_sub(zero, ew);
    if (all_above(&w, &ew) | all_above(&nw, &w))
        return none;
    lanes u = MAP(r->u, p), v = MAP(r->v, p), sum = lanes_add(u, v);
    lanes nu = lanes_all(-r->error_u), nv = lanes_all(-r->error_v);
    lanes one = lanes_all(1.0f + 2.0f * (r->error_u + r->error_v));
    if (all_above(&nu, &u) | all_above(&nv, &v) | all_above(&sum, &one))
        return none;
    lanes us = lanes_twice_high(u), vs = lanes_twice_high(v), ws = lanes_twice_high(w);
    lanes u0 = lanes_spread_01(u), v0 = lanes_spread_01(v), w0 = lanes_spread_01(w);
    struct verdict a = {0, 0xffu}, b = {0, 0xffu};
    if (wanted & 0xffu)
        a = judge_half(r, &u0, &us, &v0, &vs, &w0, &ws);
    if (wanted & 0xff00u) {
        u0 = lanes_spread_23(u);
        v0 = lanes_spread_23(v);
        w0 = lanes_spread_23(w);
        b = judge_half(r, &u0, &us, &v0, &vs, &w0, &ws);
    }
    return (struct verdict){a.hit | b.hit << LANES, a.miss | b.miss << LANES};
}

/* The pairs among `wanted` that the triangle blocks. */
INLINE unsigned pairs_blocked(const struct octree *octree, const struct bundle *bundle,
                              const struct shaft *shaft, const struct record *r, unsigned wanted)
{
    struct verdict verdict = judge(r, shaft, wanted);
    unsigned blocked = verdict.hit & wanted, open = wanted & ~verdict.hit & ~verdict.miss;
    for (int k = 0; open != 0; k++, open >>= 1) {
        if (!(open & 1u))
            continue;
        struct segment s = segment_make(bundle->from[k / BUNDLE_ENDS], bundle->to[k % BUNDLE_ENDS]);
        if (segment_is_blocked_by(&s, &octree->triangles[r->triangle], &r->plane))
            blocked |= 1u << k;
    }
    return blocked;
}

/* Tests a run of records until nothing asked is left. Returns all that is blocked now. */
static unsigned block_by_records(const struct octree *octree, struct leaf run,
                                 const struct bundle *bundle, const struct shaft *shaft,
                                 unsigned blocked, int32_t *guess, struct octree_counts *counts)
{
    const struct record *records = octree->inside.records + run.first;
    for (int32_t i = 0; i < run.count && blocked != bundle->asked; i++) {
        int32_t t = records[i].triangle;
        if (t == bundle->own[0] || t == bundle->own[1])
            continue;
        counts->triangle_tests++;
        unsigned more = pairs_blocked(octree, bundle, shaft, &records[i], bundle->asked & ~blocked);
        blocked |= more;
        *guess = more ? t : *guess;
    }
    return blocked;
}

unsigned octree_block(const struct octree *octree, const struct bundle *bundle, int32_t *guess,
                      struct octree_counts *counts)
{
    const struct tree *tree = &octree->inside;
    struct shaft shaft;
    unsigned blocked = 0;
    shaft_set_points(&shaft, bundle->from, bundle->to);
    counts->rays += bit_count(bundle->asked);
    if (*guess >= 0 && octree->place[*guess] >= 0)
        blocked = block_by_records(octree, (struct leaf){octree->place[*guess], 1}, bundle, &shaft,
                                   blocked, guess, counts);
    if (tree->node_count == 0 || blocked == bundle->asked)
        return blocked;
    shaft_set_slabs(&shaft);
    int32_t stack[TREE_STACK];
    int height = 0;
    stack[height++] = 0;
    while (height > 0 && blocked != bundle->asked) {
        if (stack[height - 1] >= 0)
            height = descend(tree, &shaft, stack, height, counts);
        else
            blocked = block_by_records(octree, leaf_of(stack[--height]), bundle, &shaft,
                                       blocked, guess, counts);
    }
    return blocked;
}

/* --- empty shafts --- */

bool octree_shaft_is_empty(const struct octree *octree, const struct triangle *p,
                           const struct plane *plane_p, const struct triangle *q,
                           const struct plane *plane_q, const int32_t own[2],
                           struct octree_counts *counts)
{
    const struct tree *tree = &octree->inside;
    struct hull hull = hull_of_pair(p, plane_p, q, plane_q);
    struct vec3 from[BUNDLE_ENDS], to[BUNDLE_ENDS];
    for (int k = 0; k < BUNDLE_ENDS; k++) {
        from[k] = p->corner[k % 3];
        to[k] = q->corner[k % 3];
    }
    struct shaft shaft;
    shaft_set(&shaft, from, to);
    int32_t stack[TREE_STACK];
    int height = 0;
    if (tree->node_count > 0)
        stack[height++] = 0;
    while (height > 0) {
        if (stack[height - 1] >= 0) {
            height = descend(tree, &shaft, stack, height, counts);
            continue;
        }
        struct leaf run = leaf_of(stack[--height]);
        for (int32_t i = run.first; i < run.first + run.count; i++) {
            int32_t t = tree->records[i].triangle;
            if (t == own[0] || t == own[1])
                continue;
            counts->triangle_tests++;
            if (hull_is_entered(&hull, &octree->triangles[t]))
                return false;
        }
    }
    return true;
}
