/* The ray caster: which triangle is met first, and which segments are blocked?
 *
 * Triangles are known by their number in the array given to octree_create(). Nothing here
 * depends on a rank, a thread or on earlier queries: the same question always takes the
 * same path, so the counters are as reproducible as the answers. Blocking is defined by
 * segment_is_blocked_by() in double precision, and the answers are exactly those. */
#ifndef OCTREE_OCTREE_H
#define OCTREE_OCTREE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/pack.h"
#include "geom/triangle.h"
#include "octree/counts.h"

struct octree;

enum {
    BUNDLE_ENDS = 4,                       /* points on either side of a bundle */
    BUNDLE_RAYS = BUNDLE_ENDS * BUNDLE_ENDS, /* segments of a bundle */
    PACKET_RAYS = 64,                        /* rays of a packet, at most */
    STREAM_RAYS = 256                        /* rays of a stream, at most */
};

/* The 16 segments between four points and four others. Segment 4 a + b runs from from[a]
 * to to[b]. The points lie in the convex hull of the scene, such as on its triangles. */
struct bundle {
    struct vec3 from[BUNDLE_ENDS], to[BUNDLE_ENDS];
    unsigned asked; /* bit 4 a + b: this segment is wanted; from[a] != to[b] */
    int32_t own[2]; /* triangles on which the points lie, never blocking; -1: none */
};

struct octree_hit {
    int32_t triangle;
    bool front;       /* the front of the triangle is met */
    double weight[3]; /* barycentric coordinates of the point: octree_hit_weights() */
};

/* Rays to anywhere, and what each meets first. */
struct stream {
    struct vec3 origins[STREAM_RAYS], directions[STREAM_RAYS];
    struct octree_hit hits[STREAM_RAYS]; /* without weights */
    int count;
};

/* Builds the octree over `count` triangles and their planes, in scene units (the box
 * around them fits in [-1/2, 1/2]^3). Triangles whose plane has a zero normal (dropped
 * ones) are left out. Borrows both arrays, which must outlive the octree. */
struct octree *octree_create(const struct triangle *triangles, const struct plane *planes,
                             int32_t count);
void octree_destroy(struct octree *octree);

/* Into a block, and as laid out there: read-only, valid as long as the block. The
 * triangles and planes are not packed: the view is given the same ones. */
void octree_pack(const struct octree *octree, struct pack *pack);
struct octree *octree_view(struct pack *pack, const struct triangle *triangles,
                           const struct plane *planes);

/* Which of the segments asked for are blocked: bits as in `asked`. `*guess` is a triangle
 * to test first, such as the last blocker of a similar bundle, or -1; and becomes the
 * last blocker of some segment. A guess saves time and never changes the answer. */
unsigned octree_block(const struct octree *octree, const struct bundle *bundle,
                      int32_t *guess, struct octree_counts *counts);

/* True if the segment between two points of the hull of the scene is blocked; own and
 * guess as above. A few segments in different directions are cheaper one by one than as
 * part of a bundle, which goes down wherever anything between its outermost points might
 * be. */
bool octree_blocks_segment(const struct octree *octree, struct vec3 from, struct vec3 to,
                           const int32_t own[2], int32_t *guess,
                           struct octree_counts *counts);

/* True if a wall is proved to block all segments between two convex sets, given by their
 * corners (geom/wall.h). Tries the walls blocking the segment between the means of the
 * corners; no others can. */
bool octree_has_wall(const struct octree *octree, const struct vec3 *p, int count_p,
                     const struct vec3 *q, int count_q, struct octree_counts *counts);

/* Finds the triangles reaching into the shaft between two, their convex hull in front of
 * both planes: all possible blockers of a segment from front to front. Writes at most
 * `most` numbers into `entrants`, in ascending order. Returns their number; most + 1 if
 * there are more. None is a proof that the way is open. `own`: their numbers, as
 * above. */
int32_t octree_list_shaft(const struct octree *octree, const struct triangle *p,
                          const struct plane *plane_p, const struct triangle *q,
                          const struct plane *plane_q, const int32_t own[2],
                          int32_t *entrants, int32_t most, struct octree_counts *counts);

/* The triangle that the ray from `origin` along `direction` (of any length but 0) meets
 * first. Of triangles met in the same place a front counts before a back, then the
 * largest number: decals come after the surface below. `fronts_only` looks through backs.
 * False if nothing is met. */
bool octree_first_hit(const struct octree *octree, struct vec3 origin,
                      struct vec3 direction, bool fronts_only, struct octree_hit *hit,
                      struct octree_counts *counts);

/* Sets the weights of what a ray meets first. */
void octree_hit_weights(const struct octree *octree, struct vec3 origin,
                        struct vec3 direction, struct octree_hit *hit);

/* octree_first_hit() of 1 to PACKET_RAYS rays from one point, and weights; the triangle
 * of a ray meeting nothing becomes -1. Answers are the same to the bit, and come sooner
 * if the rays go to almost the same place, as those of neighbouring pixels do. */
void octree_first_hits(const struct octree *octree, struct vec3 origin,
                       const struct vec3 *directions, int count, bool fronts_only,
                       struct octree_hit *hits, struct octree_counts *counts);

/* octree_first_hit() of all rays of a stream; the triangle of a ray meeting nothing
 * becomes -1. Answers are the same, and come sooner with many rays, most of all with
 * starts near to each other. */
void octree_stream_hits(const struct octree *octree, struct stream *stream,
                        bool fronts_only, struct octree_counts *counts);

#endif
