/* The octree in memory; for octree/ only. */
#ifndef OCTREE_TREE_H
#define OCTREE_TREE_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/pack.h"
#include "geom/triangle.h"
#include "octree/lanes.h"

enum {
    LEAF_MAX = 16,   /* triangles of a leaf, at most */
    TREE_DEPTH = 24, /* from this level on cells are cut by number, not by place */
    TREE_LEVELS = 36 /* a number below 2^31 is at most LEAF_MAX after 9 cuts in eight */
};

/* For small functions called millions of times from a few places each, where a compiler's
 * own judgement is against inlining. */
#ifdef __GNUC__
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

/* By this margin boxes are wider than their triangles, in scene units, for the rounding
 * of tests: coordinates are below 1.3 and direction components at most 1, so that each of
 * some ten operations is off by at most 2^-24. */
static const float BOX_MARGIN = 2e-6f;

/* An inner node: the boxes of its eight children side by side, so that one instruction
 * looks at all eight. The box of an absent child is far away and inside out, so nothing
 * meets it. Children are in the order of the octants, bit k of which is the side along
 * axis k. */
struct node {
    float bound[3][2][LANES]; /* per axis, the low and the high side */
    int32_t child[LANES]; /* an inner node if >= 0; a leaf if < 0, see leaf_of() */
};

/* A run of records. */
struct leaf {
    int32_t first, count; /* 1 <= count <= LEAF_MAX */
};

/* The leaf of a negative child: ~(LEAF_MAX * first + count - 1). */
static inline struct leaf leaf_of(int32_t child)
{
    return (struct leaf){~child / LEAF_MAX, ~child % LEAF_MAX + 1};
}

/* A triangle as its plane and two affine maps r(x) = r[0] x + r[1] y + r[2] z + r[3]: the
 * barycentric coordinates of corners b and c. 80 bytes. */
struct record {
    struct plane plane; /* of the triangle */
    float u[4], v[4];
    float error_u, error_v; /* bounds on |r(x) - its exact value| for |x| <= 1 */
    float error_w;          /* such a bound for the distance to the plane as a map */
    int32_t triangle;
};

/* A record's map r at x. */
INLINE float map_at(const float r[4], const float x[3])
{
    return r[0] * x[0] + r[1] * x[1] + r[2] * x[2] + r[3];
}

/* One tree over some of the triangles. */
struct tree {
    struct node *nodes;     /* [node_count]; the first is the root */
    struct record *records; /* [record_count], leaf by leaf */
    int64_t node_count, node_capacity, record_count;
};

struct octree {
    const struct triangle *triangles;
    const struct plane *planes;
    struct tree inside; /* triangles able to block a segment between two scene points */
    struct tree hull;   /* triangles with the whole scene on one side */
    int32_t *place;      /* [count] where a triangle's record is in `inside`, or -1 */
    int32_t *neighbours; /* [3 count] of the triangles in their walls, or -1 */
    int64_t count;
    struct vec3 middle;    /* of the bounding box */
    double radius;         /* of a ball around the box */
    bool is_view;          /* the arrays lie in memory of others */
};

/* Builds a tree over `count` triangles, given by number. */
struct tree tree_build(const struct triangle *triangles, const struct plane *planes,
                       const int32_t *order, int32_t count);
void tree_free(struct tree *tree);

/* The next arrays of the pack become those of the tree. */
void tree_pack_arrays(struct tree *tree, struct pack *pack);

#endif
