/* First hits: one ray goes down the tree, to the nearest box first (octree/ray.h), or
 * hundreds at a time.
 *
 * The ray is cut to a segment leaving the scene. By the t of entry, boxes behind the hit
 * are passed over, also those met before there was a hit. The point where the ray crosses
 * a triangle's plane is known in double, so the triangle left by the ray, and triangles
 * in a tie, cost no more than others; float is sure of the inside of a triangle, but for
 * edges, where segment_line_meets() decides. So the answers are those of geom/triangle.c
 * to the bit.
 *
 * Two fifths of a ray's time are wrong guesses of the processor, ten a ray. A stream of
 * rays takes loops instead of branches: all rays of a stream in a node look at the boxes
 * of the node, and then each child has the list of its rays, which takes one subtraction
 * a ray and child. Each ray sees leaves in the same order as alone, so its answer is the
 * same; a few more nodes are looked at, for the ray is on the list of a child before its
 * hit is known. 256 rays from one leaf take 0.65 of the time taken one by one, in rooms
 * of 6,348 and 31,936 triangles; others gain little.
 *
 * Rejected: planes in float, and doubtful ones in double (each ray is in doubt about the
 * triangle it leaves); eight children pushed without branches; an entry of the stack for
 * each child; sixteen rays in turn, a node of each at a time; fetching ahead of time;
 * records and nodes at multiples of 64 bytes; one tree for all, whose large walls get in
 * the way of the furniture; in streams, lists filled child by child for each ray, two
 * passes over the triangles of a leaf. */
#include "octree/octree.h"
#include "octree/ray.h"

/* A search for a first hit. */
struct search {
    const struct octree *octree;
    struct ray ray;
    double nearest;   /* t of the hit; 2 before there is one */
    int32_t triangle; /* the hit; -1 before there is one */
    bool front, fronts_only;
};

static const float REACH_MARGIN = 1e-6f; /* more than ties, and than rounding of t */

/* Of two triangles met in the same place, a front counts before a back (the wall of the
 * next room lies back to back with ours), then the one later in the file. */
static bool wins_tie(const struct search *search, int32_t t, bool front)
{
    return front != search->front ? front : t > search->triangle;
}

static bool line_meets(const struct search *search, int32_t t)
{
    struct segment line = segment_make(search->ray.from, search->ray.to);
    return segment_line_meets(&line, &search->octree->triangles[t], NULL);
}

/* Tests one triangle. A hit counts before the hit so far, or in the same place if the
 * triangle wins the tie. */
INLINE void improve_hit(struct search *search, const struct record *r)
{
    struct ends ends = ends_of(&search->ray, r);
    bool front = ends.from > 0.0;
    if ((front == (ends.to > 0.0)) | (search->fronts_only & !front))
        return; /* before a division is waited for */
    double at = ends.from / (ends.from - ends.to), tie = 64.0 * GEOM_ROUNDING;
    bool is_behind = at > search->nearest + tie;
    enum passage passage = is_behind ? MISSES : ray_passes(&search->ray, r, ends, at);
    if (passage == MISSES ||
        (at > search->nearest - tie && !wins_tie(search, r->triangle, front)) ||
        (passage == MAY_MEET && !line_meets(search, r->triangle)))
        return;
    search->nearest = at < search->nearest ? at : search->nearest;
    search->triangle = r->triangle;
    search->front = front;
    search->ray.reach = (float)search->nearest + REACH_MARGIN;
}

/* Visits a leaf, for ray_walk(). */
INLINE bool search_leaf(void *at, const struct record *records, int32_t count,
                        struct octree_counts *counts)
{
    struct search *search = at;
    counts->triangle_tests += count;
    for (int32_t i = 0; i < count; i++)
        improve_hit(search, &records[i]);
    return false;
}

/* Begins the search of a ray. Returns false if the ray misses the scene. */
INLINE bool begin_search(struct search *search, const struct octree *octree,
                         struct vec3 origin, struct vec3 direction, bool fronts_only)
{
    struct vec3 end;
    search->octree = octree;
    search->nearest = 2.0;
    search->triangle = -1;
    search->front = false;
    search->fronts_only = fronts_only;
    if (!ray_clip(octree, &origin, direction, &end))
        return false;
    ray_set(&search->ray, origin, end);
    return true;
}

bool octree_first_hit(const struct octree *octree, struct vec3 origin,
                      struct vec3 direction, bool fronts_only, struct octree_hit *hit,
                      struct octree_counts *counts)
{
    struct search search; /* set by parts, since the ray is large */
    const float *reach = &search.ray.reach;
    counts->rays++;
    if (begin_search(&search, octree, origin, direction, fronts_only)) {
        ray_walk(&octree->inside, &search.ray, reach, search_leaf, &search, counts);
        ray_walk(&octree->hull, &search.ray, reach, search_leaf, &search, counts);
    }
    hit->triangle = search.triangle;
    hit->front = search.front;
    return hit->triangle >= 0;
}

void octree_hit_weights(const struct octree *octree, struct vec3 origin,
                        struct vec3 direction, struct octree_hit *hit)
{
    struct vec3 end;
    ray_clip(octree, &origin, direction, &end);
    struct segment line = segment_make(origin, end);
    segment_line_meets(&line, &octree->triangles[hit->triangle], hit->weight);
}

/* --- many rays --- */

/* The rays of a stream with one nearest octant, on their way down a tree. */
struct group {
    const struct tree *tree;
    struct search *searches; /* of all rays */
    struct octree_counts *counts;
    int32_t (*met)[LANES]; /* [STREAM_RAYS] of one node; -1: a ray meets a child's box */
    int near;
};

static void group_walk(const struct group *group, int32_t child, const uint8_t *rays,
                       int count);

/* Goes down to the children of a node, to each with the rays meeting its box. */
static void group_split(const struct group *group, const struct node *node,
                        const uint8_t *rays, int count)
{
    uint8_t meeting[LANES][STREAM_RAYS]; /* of each child */
    int numbers[LANES];
    lanes_mask in, any = mask_all(0), weights;
    lanes enter;
    for (int i = 0; i < count; i++) {
        ray_boxes(&group->searches[rays[i]].ray, group->near, node, &in, &enter);
        memcpy(group->met[i], &in, sizeof in);
        any = mask_or(any, in);
    }
    mask_set_weights(&weights, group->near);
    unsigned children = mask_select(&any, &weights);
    for (unsigned left = children; left != 0; left &= left - 1) {
        int bit = lowest_bit(left), k = bit ^ group->near, number = 0;
        for (int i = 0; i < count; i++) {
            meeting[bit][number] = rays[i];
            number -= group->met[i][k];
        }
        numbers[bit] = number;
    }
    for (unsigned left = children; left != 0; left &= left - 1) {
        int bit = lowest_bit(left);
        group_walk(group, node->child[bit ^ group->near], meeting[bit], numbers[bit]);
    }
}

/* Goes down to a child whose box these rays meet. */
static void group_walk(const struct group *group, int32_t child, const uint8_t *rays,
                       int count)
{
    if (child >= 0) {
        group->counts->node_tests += count;
        group_split(group, &group->tree->nodes[child], rays, count);
        return;
    }
    struct leaf leaf = leaf_of(child);
    group->counts->triangle_tests += (int64_t)leaf.count * count;
    for (int32_t k = leaf.first; k < leaf.first + leaf.count; k++)
        for (int i = 0; i < count; i++)
            improve_hit(&group->searches[rays[i]], &group->tree->records[k]);
}

void octree_stream_hits(const struct octree *octree, struct stream *stream,
                        bool fronts_only, struct octree_counts *counts)
{
    struct search searches[STREAM_RAYS];
    int32_t met[STREAM_RAYS][LANES];
    uint8_t rays[LANES][STREAM_RAYS];
    int sizes[LANES] = {0};
    counts->rays += stream->count;
    for (int i = 0; i < stream->count; i++) {
        struct search *search = &searches[i];
        if (begin_search(search, octree, stream->origins[i], stream->directions[i],
                         fronts_only))
            rays[search->ray.near][sizes[search->ray.near]++] = (uint8_t)i;
    }
    for (int k = 0; k < 2 * LANES; k++) {
        const struct tree *tree = k & 1 ? &octree->hull : &octree->inside;
        struct group group = {tree, searches, counts, met, k / 2};
        if (tree->node_count > 0 && sizes[k / 2] > 0)
            group_walk(&group, 0, rays[k / 2], sizes[k / 2]);
    }
    for (int i = 0; i < stream->count; i++) {
        stream->hits[i].triangle = searches[i].triangle;
        stream->hits[i].front = searches[i].front;
    }
}
