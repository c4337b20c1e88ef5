/* First hits: one ray goes down the tree, to the nearest box first (octree/ray.h).
 *
 * The ray is cut to a segment that leaves the scene. The t at which it enters a box lets
 * boxes be passed over that are behind the hit, also those that were met before there was
 * one. Where it crosses a triangle's plane is known in double, so that the triangle which
 * the ray leaves, and those that tie, cost no more than others; float is sure of the
 * inside of a triangle, but for edges, where segment_line_meets() decides. So the answers
 * are those of geom/triangle.c to the bit.
 *
 * The cost of a ray is in wrong guesses and waits of the processor. Rejected therefore
 * (tests/bench/hits.c, a room of 6,348 triangles): planes in float, and doubtful ones in
 * double (a tenth to a quarter slower: each ray is in doubt about the triangle that it
 * leaves); a shaft made anew at each hit; eight children pushed without branches (a chain
 * of eight additions); an entry of the stack for each child; sixteen rays in turn, a node
 * of each at a time (wrong guesses of one hold up all); fetching ahead of time; records
 * and nodes at multiples of 64 bytes; one tree for all, whose large walls get in the way
 * of the furniture. */
#include "octree/octree.h"
#include "octree/ray.h"

/* A first hit that is looked for. */
struct search {
    const struct octree *octree;
    struct ray ray;
    bool fronts_only;
    double nearest; /* t of the hit; 2 before there is one */
    struct octree_hit hit;
};

static const float REACH_MARGIN = 1e-6f; /* more than ties, and than rounding of t */

/* Of two triangles met in the same place, a front counts before a back (the wall of the
 * next room lies back to back with ours), then the one that comes later in the file. */
static bool wins_tie(const struct octree_hit *hit, int32_t t, bool front)
{
    return front != hit->front ? front : t > hit->triangle;
}

static bool line_meets(const struct search *search, int32_t t, double weight[3])
{
    struct segment line = segment_make(search->ray.from, search->ray.to);
    return segment_line_meets(&line, &search->octree->triangles[t], weight);
}

/* Tests one triangle; it counts if it is met before the hit so far, or in the same place
 * and wins the tie. */
INLINE void improve_hit(struct search *search, const struct record *r)
{
    struct ends ends = ends_of(&search->ray, r);
    bool front = ends.from > 0.0;
    double at = ends.from / (ends.from - ends.to), tie = 64.0 * GEOM_ROUNDING;
    if ((front == (ends.to > 0.0)) | (at > search->nearest + tie) |
        (search->fronts_only & !front))
        return;
    enum passage passage = ray_passes(&search->ray, r, ends, at);
    if (passage == MISSES ||
        (at > search->nearest - tie && !wins_tie(&search->hit, r->triangle, front)) ||
        (passage == MAY_MEET && !line_meets(search, r->triangle, NULL)))
        return;
    search->nearest = at < search->nearest ? at : search->nearest;
    search->hit.triangle = r->triangle;
    search->hit.front = front;
}

/* Visits a leaf, for ray_walk(). */
INLINE bool search_leaf(void *at, const struct record *records, int32_t count,
                        struct octree_counts *counts)
{
    struct search *search = at;
    counts->triangle_tests += count;
    for (int32_t i = 0; i < count; i++)
        improve_hit(search, &records[i]);
    search->ray.reach = (float)search->nearest + REACH_MARGIN;
    return false;
}

bool octree_first_hit(const struct octree *octree, struct vec3 origin,
                      struct vec3 direction, bool fronts_only, struct octree_hit *hit,
                      struct octree_counts *counts)
{
    struct search search; /* set by parts, since the ray is large */
    struct vec3 end;
    counts->rays++;
    search.octree = octree;
    search.fronts_only = fronts_only;
    search.nearest = 2.0;
    search.hit.triangle = hit->triangle = -1;
    if (!ray_clip(octree, &origin, direction, &end))
        return false;
    ray_set(&search.ray, origin, end);
    const float *reach = &search.ray.reach;
    ray_walk(&octree->inside, &search.ray, reach, search_leaf, &search, counts);
    ray_walk(&octree->hull, &search.ray, reach, search_leaf, &search, counts);
    *hit = search.hit;
    if (hit->triangle < 0)
        return false;
    return line_meets(&search, hit->triangle, hit->weight);
}
