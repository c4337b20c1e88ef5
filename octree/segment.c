/* One segment: is it blocked, and is there a wall?
 *
 * A segment goes down like a ray (octree/ray.h), to the nearest box first, and the first
 * blocker ends the walk. Float counts where sure; all else is decided by
 * segment_is_blocked_by() in double, so the answers are those of geom/triangle.c to the
 * bit. Links of clusters ask for few segments each, to places far apart, and are better
 * off so than with bundles.
 *
 * Rejected: a shaft without width (octree/shaft.h), whose separating axes take twice as
 * many operations a box; a walk without branches (8 % slower: a right guess spares the
 * wait for the node before); the farthest box first, larger leaves, fetching what waits
 * ahead of time (no gain). */
#include <stddef.h>

#include "geom/wall.h"
#include "octree/octree.h"
#include "octree/ray.h"

/* One segment on its way. */
struct query {
    const struct octree *octree;
    struct ray ray;
    const int32_t *own;
    int32_t blocker;
};

/* As segment_is_blocked_by(). */
static inline bool is_blocked_by(const struct query *query, const struct record *r)
{
    struct ends ends = ends_of(&query->ray, r);
    bool down = (ends.from > GEOM_ROUNDING) & (ends.to < -GEOM_ROUNDING);
    bool up = (ends.from < -GEOM_ROUNDING) & (ends.to > GEOM_ROUNDING);
    if (!(down | up))
        return false;
    enum passage passage =
        ray_passes(&query->ray, r, ends, ends.from / (ends.from - ends.to));
    if (passage != MAY_MEET)
        return passage == MEETS;
    struct segment s = segment_make(query->ray.from, query->ray.to);
    return segment_line_meets(&s, &query->octree->triangles[r->triangle], NULL);
}

/* Visits a leaf, for ray_walk(). */
INLINE bool find_blocker(void *at, const struct record *records, int32_t count,
                         struct octree_counts *counts)
{
    struct query *query = at;
    counts->triangle_tests += count;
    for (int32_t i = 0; i < count; i++) {
        int32_t t = records[i].triangle;
        if (t != query->own[0] && t != query->own[1] &&
            is_blocked_by(query, &records[i])) {
            query->blocker = t;
            return true;
        }
    }
    return false;
}

bool octree_blocks_segment(const struct octree *octree, struct vec3 from, struct vec3 to,
                           const int32_t own[2], int32_t *guess,
                           struct octree_counts *counts)
{
    const struct tree *tree = &octree->inside;
    struct query query; /* set by parts, since the ray is large */
    int32_t place = *guess >= 0 ? octree->place[*guess] : -1;
    counts->rays++;
    query.octree = octree;
    query.own = own;
    ray_set(&query.ray, from, to);
    if (place >= 0 && find_blocker(&query, &tree->records[place], 1, counts))
        return true;
    if (!ray_walk(tree, &query.ray, NULL, find_blocker, &query, counts))
        return false;
    *guess = query.blocker;
    return true;
}

/* --- walls --- */

/* Two convex sets between which a wall is looked for. */
struct wall_query {
    struct query middle; /* the segment between the means of their corners */
    const struct vec3 *p, *q;
    int count_p, count_q;
};

/* Visits a leaf, for ray_walk(). */
INLINE bool find_wall(void *at, const struct record *records, int32_t count,
                      struct octree_counts *counts)
{
    const struct wall_query *query = at;
    const struct octree *octree = query->middle.octree;
    const struct walls walls = {octree->triangles, octree->planes, octree->neighbours};
    counts->triangle_tests += count;
    for (int32_t i = 0; i < count; i++)
        if (is_blocked_by(&query->middle, &records[i]) &&
            walls_stand_between(&walls, records[i].triangle, query->p, query->count_p,
                                query->q, query->count_q))
            return true;
    return false;
}

static struct vec3 mean_of(const struct vec3 *corners, int count)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int k = 0; k < count; k++)
        sum = vec3_add(sum, corners[k]);
    return vec3_scale(sum, 1.0 / count);
}

bool octree_has_wall(const struct octree *octree, const struct vec3 *p, int count_p,
                     const struct vec3 *q, int count_q, struct octree_counts *counts)
{
    struct wall_query query = {.middle = {.octree = octree},
                               .p = p, .q = q, .count_p = count_p, .count_q = count_q};
    ray_set(&query.middle.ray, mean_of(p, count_p), mean_of(q, count_q));
    return ray_walk(&octree->inside, &query.middle.ray, NULL, find_wall, &query, counts);
}
