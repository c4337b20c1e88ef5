/* First hits: one ray goes down the tree, to the nearest box first.
 *
 * The ray is cut to the segment x = from + t (to - from), 0 <= t <= 1, that leaves the
 * scene. A box is met from the largest of the three t at which it enters the box's slabs
 * to the smallest at which it leaves them: half the operations of a shaft's separating
 * axes, and the t of entry lets boxes be passed over that are behind the hit, also those
 * that were met before there was one. One entry of the stack is a node with the children
 * that wait, the nearest octant being the lowest bit; the nearest is gone down to at
 * once.
 *
 * A triangle is looked at in float, where the ray crosses its plane. With w the signed
 * distance, t = -w(from) / (w(to) - w(from)) is off by at most 3 error_w / |w(to) -
 * w(from)|, since error_w bounds both, and the point by 2.5 times as much and 20 x 2^-24,
 * no coordinate of to - from being above 2.5. A map of error e has a gradient below 2^20
 * e (octree/build.c): so much for the margins of may_improve(). They hold for coordinates
 * up to 1.3, where a segment ends. What is not certainly missed is decided in double, so
 * the answers are those of geom/triangle.c to the bit.
 *
 * What a ray costs is waiting: for the operations of a node, each for the one before, and
 * for what the processor has guessed wrongly. Rejected therefore (tests/bench/hits.c, a
 * room of 6,348 triangles): a shaft made anew at each hit, with all triangles in double
 * (5,080 instructions a ray; these are 3,270, and two thirds to three quarters of the
 * time); eight children pushed without branches (a chain of eight additions); an entry of
 * the stack for each child; sixteen rays in turn, a node of each at a time (wrong guesses
 * of one hold up all; it gains only on stray rays in scenes far beyond the caches);
 * fetching ahead of time. */
#include <string.h>

#include "octree/tree.h"

/* A ray for boxes. A step of less than STEP_LEAST along an axis counts as that, so that
 * its inverse is a number. */
struct track {
    lanes origin[3];    /* where the ray begins */
    lanes inverse[3];   /* 1 / its step along an axis */
    lanes steepness[3]; /* |inverse| */
    lanes margin[3];    /* BOX_MARGIN as a share of the step */
    lanes_mask weights; /* of the children: that of octant k ^ near is bit k */
    int near;           /* the nearest octant: a bit for each axis that it runs down */
};

/* A ray on its way. */
struct search {
    const struct octree *octree;
    struct vec3 from, to;
    struct segment segment;
    float origin[3], step[3];
    struct track track;
    bool fronts_only;
    double nearest; /* t of the hit; 2 before there is one */
    float reach;    /* a little more: nothing beyond it is of use */
    struct octree_hit hit;
};

/* A node some of whose children wait. */
struct waiting {
    const struct node *node;
    unsigned met;       /* as bits of the track's weights */
    float enter[LANES]; /* t at which the ray enters each child's box */
};

static const float STEP_LEAST = 1e-12f;
static const float REACH_MARGIN = 1e-6f; /* more than ties, and than rounding of t */

static void track_set(struct track *track, const float origin[3], const float step[3])
{
    track->near = 0;
    for (int axis = 0; axis < 3; axis++) {
        float size = fabsf(step[axis]);
        float inverse = 1.0f / (size > STEP_LEAST ? size : STEP_LEAST);
        bool down = step[axis] < 0.0f;
        track->near |= down << axis;
        track->origin[axis] = lanes_all(origin[axis]);
        track->inverse[axis] = lanes_all(down ? -inverse : inverse);
        track->steepness[axis] = lanes_all(inverse);
        track->margin[axis] = lanes_all(inverse * BOX_MARGIN);
    }
    mask_set_weights(&track->weights, track->near);
}

/* --- boxes --- */

/* t in the middle of a slab, and from there to its sides. */
#define SLAB_MIDDLE(node, track, axis)                                          \
    lanes_mul(lanes_sub(lanes_at((node)->middle[axis]), (track)->origin[axis]), \
              (track)->inverse[axis])
#define SLAB_HALF(node, track, axis)                                             \
    lanes_add(lanes_mul(lanes_at((node)->half[axis]), (track)->steepness[axis]), \
              (track)->margin[axis])

/* Children whose boxes the ray may meet within reach. */
INLINE unsigned children_entered(const struct node *node, const struct track *track,
                                 float reach, float enter[LANES])
{
    lanes m0 = SLAB_MIDDLE(node, track, 0), h0 = SLAB_HALF(node, track, 0);
    lanes m1 = SLAB_MIDDLE(node, track, 1), h1 = SLAB_HALF(node, track, 1);
    lanes m2 = SLAB_MIDDLE(node, track, 2), h2 = SLAB_HALF(node, track, 2);
    lanes n0 = lanes_sub(m0, h0), n1 = lanes_sub(m1, h1), n2 = lanes_sub(m2, h2);
    lanes zero = lanes_all(0.0f), most = lanes_all(reach);
    lanes first = lanes_max(n2, zero), other = lanes_max(n0, n1);
    first = lanes_max(first, other);
    lanes_mask out = mask_or(mask_or(lanes_above(first, lanes_add(m0, h0)),
                                     lanes_above(first, lanes_add(m1, h1))),
                             mask_or(lanes_above(first, lanes_add(m2, h2)),
                                     lanes_above(first, most)));
    memcpy(enter, &first, LANES * sizeof *enter);
    return ~mask_select(&out, &track->weights) & 0xffu;
}

/* --- triangles --- */

/* Of two triangles met in the same place, a front counts before a back (the wall of the
 * next room lies back to back with ours), then the one that comes later in the file. */
static bool wins_tie(const struct octree_hit *hit, int32_t t, bool front)
{
    return front != hit->front ? front : t > hit->triangle;
}

/* Tests one triangle; it counts if it is met before the hit so far, or in the same place
 * and wins the tie. */
static void improve_hit(struct search *search, int32_t t)
{
    const struct plane *plane = &search->octree->planes[t];
    double start = plane_distance(plane, search->from);
    double end = plane_distance(plane, search->to);
    if ((start > 0.0) == (end > 0.0) || (search->fronts_only && start <= 0.0))
        return;
    double at = start / (start - end), tie = 64.0 * GEOM_ROUNDING, weight[3];
    if (at > search->nearest + tie ||
        (at > search->nearest - tie && !wins_tie(&search->hit, t, start > 0.0)))
        return;
    if (!segment_line_meets(&search->segment, &search->octree->triangles[t], weight))
        return;
    search->nearest = at < search->nearest ? at : search->nearest;
    search->reach = (float)search->nearest + REACH_MARGIN;
    search->hit = (struct octree_hit){t, start > 0.0, {weight[0], weight[1], weight[2]}};
}

/* False if it is certain that the triangle does not improve the hit. */
INLINE bool may_improve(const struct search *search, const struct record *r)
{
    const float *o = search->origin, *d = search->step;
    float eu = r->error_u, ev = r->error_v, ew = r->error_w;
    float start = map_at(r->w, o);
    float change = r->w[0] * d[0] + r->w[1] * d[1] + r->w[2] * d[2];
    if (fabsf(change) <= 8.0f * ew)
        return true;
    float inverse = 1.0f / change, t = -start * inverse, doubt = ew * fabsf(inverse);
    if ((t < -3.0f * doubt) | (t > search->reach + 3.0f * doubt))
        return false;
    float x[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
    float u = map_at(r->u, x), v = map_at(r->v, x), slack = 2.5f + 6.5e6f * doubt;
    float mu = eu * slack, mv = ev * slack;
    return !((u < -mu) | (v < -mv) | (u + v > 1.0f + mu + mv));
}

static void search_leaf(struct search *search, const struct tree *tree, struct leaf leaf)
{
    const struct record *records = &tree->records[leaf.first];
    for (int32_t i = 0; i < leaf.count; i++)
        if (may_improve(search, &records[i]))
            improve_hit(search, records[i].triangle);
}

/* --- the walk --- */

/* Takes the next child within reach off the stack. Returns false if there is none. */
INLINE bool take_next(struct waiting *stack, int *height, int near, float reach,
                      int32_t *child)
{
    while (*height > 0) {
        struct waiting *top = &stack[*height - 1];
        int k = lowest_bit(top->met) ^ near;
        top->met &= top->met - 1;
        *height -= top->met == 0;
        if (top->enter[k] <= reach) {
            *child = top->node->child[k];
            return true;
        }
    }
    return false;
}

/* Goes down to the nearest child as long as there is one, tests its triangles, and goes
 * on with what waits. */
static void search_tree(struct search *search, const struct tree *tree,
                        struct octree_counts *counts)
{
    struct waiting stack[TREE_LEVELS]; /* at most one for each level */
    int height = 0;
    int32_t child = 0;
    if (tree->node_count == 0)
        return;
    do {
        while (child >= 0) {
            struct waiting *top = &stack[height];
            const struct node *node = &tree->nodes[child];
            unsigned met = children_entered(node, &search->track, search->reach,
                                            top->enter);
            counts->node_tests++;
            if (met == 0)
                break;
            top->node = node;
            top->met = met & (met - 1);
            height += top->met != 0;
            child = node->child[lowest_bit(met) ^ search->track.near];
        }
        if (child < 0) {
            struct leaf leaf = leaf_of(child);
            search_leaf(search, tree, leaf);
            counts->triangle_tests += leaf.count;
        }
    } while (take_next(stack, &height, search->track.near, search->reach, &child));
}

/* Cuts the ray to a segment that ends behind the scene and begins no further from it than
 * its own size: what a camera far away needs to keep its digits. False if it misses. */
static bool clip_to_scene(struct vec3 low, struct vec3 high, struct vec3 *origin,
                          struct vec3 direction, struct vec3 *end)
{
    struct vec3 middle = vec3_middle(low, high);
    double radius = 0.5 * vec3_length(vec3_sub(high, low)) * 1.0001 + GEOM_ROUNDING;
    struct vec3 d = vec3_scale(direction, 1.0 / vec3_length(direction));
    double along = vec3_dot(vec3_sub(middle, *origin), d), begin = along - radius;
    if (along + radius <= 0.0)
        return false;
    *end = vec3_add(*origin, vec3_scale(d, along + radius));
    if (begin > 0.0)
        *origin = vec3_add(*origin, vec3_scale(d, begin));
    struct vec3 nearest = vec3_add(*origin, vec3_scale(d, begin > 0.0 ? radius : along));
    return vec3_length(vec3_sub(nearest, middle)) <= radius;
}

static void set_segment(struct search *search)
{
    struct ends ends = ends_of(search->from, search->to);
    search->segment = segment_make(search->from, search->to);
    for (int axis = 0; axis < 3; axis++) {
        search->origin[axis] = ends.from[axis];
        search->step[axis] = ends.to[axis] - ends.from[axis];
    }
    track_set(&search->track, search->origin, search->step);
}

bool octree_first_hit(const struct octree *octree, struct vec3 origin,
                      struct vec3 direction, bool fronts_only, struct octree_hit *hit,
                      struct octree_counts *counts)
{
    struct search search;
    search.octree = octree;
    search.from = origin;
    search.fronts_only = fronts_only;
    search.nearest = 2.0;
    search.reach = 1.0f;
    search.hit.triangle = -1;
    counts->rays++;
    if (!clip_to_scene(octree->low, octree->high, &search.from, direction, &search.to))
        return false;
    set_segment(&search);
    search_tree(&search, &octree->inside, counts);
    search_tree(&search, &octree->hull, counts);
    *hit = search.hit;
    return hit->triangle >= 0;
}
