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
    double nearest;   /* t of the hit; 2 before there is one */
    int32_t triangle; /* the hit; -1 before there is one */
    bool front, fronts_only;
};

static const float REACH_MARGIN = 1e-6f; /* more than ties, and than rounding of t */

/* Of two triangles met in the same place, a front counts before a back (the wall of the
 * next room lies back to back with ours), then the one that comes later in the file. */
static bool wins_tie(const struct search *search, int32_t t, bool front)
{
    return front != search->front ? front : t > search->triangle;
}

static bool line_meets(const struct search *search, int32_t t)
{
    struct segment line = segment_make(search->ray.from, search->ray.to);
    return segment_line_meets(&line, &search->octree->triangles[t], NULL);
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

/* Begins the search of a ray. Returns false if it misses the scene. */
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
