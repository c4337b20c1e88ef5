/* The ray caster: which triangle is met first, and is a segment blocked?
 *
 * Triangles are known by their number in the array that the octree is built over. Nothing here
 * depends on a rank, a thread or on earlier queries: the same question always takes the same
 * path, so that the counters are as reproducible as the answers. */
#ifndef OCTREE_OCTREE_H
#define OCTREE_OCTREE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/triangle.h"

struct octree;

/* Work done, for predicting and reporting cost. */
struct octree_counts {
    int64_t rays;           /* questions asked */
    int64_t node_tests;     /* boxes tested against a segment */
    int64_t triangle_tests; /* triangles tested against a segment */
};

struct octree_hit {
    int32_t triangle;
    bool front;       /* the front of the triangle is met */
    double weight[3]; /* barycentric coordinates of the point */
};

/* Builds the octree over `count` triangles and their planes. Triangles whose plane has a zero
 * normal (dropped ones) are left out. Borrows both arrays, which must outlive it. */
struct octree *octree_create(const struct triangle *triangles, const struct plane *planes,
                             int32_t count);
void octree_destroy(struct octree *octree);

/* A triangle that the octree was built over, and its plane. */
const struct triangle *octree_triangle(const struct octree *octree, int32_t triangle);
const struct plane *octree_plane(const struct octree *octree, int32_t triangle);

/* The triangle that blocks the segment (segment_is_blocked_by() says what that means), or -1.
 * The triangles `own[0]` and `own[1]`, on which the end points lie, never block.
 * `guess` is tested first unless it is -1: the last blocker of a similar segment. */
int32_t octree_blocker(const struct octree *octree, struct vec3 from, struct vec3 to,
                       const int32_t own[2], int32_t guess, struct octree_counts *counts);

/* The triangle that the ray from `origin` along `direction` (of any length but 0) meets first.
 * Of triangles met in the same place a front counts before a back, then the largest number: what
 * a file lays over a surface comes after it. `fronts_only` looks through backs. False if nothing is met. */
bool octree_first_hit(const struct octree *octree, struct vec3 origin, struct vec3 direction,
                      bool fronts_only, struct octree_hit *hit, struct octree_counts *counts);

#endif
