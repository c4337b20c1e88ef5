/* The shaft of all segments between two sets of four points; for octree/ only.
 *
 * A box is compared with the shaft by separating axes: the three of the box, and the
 * cross products of each with the direction of the shaft. No division, so nothing special
 * happens in axis planes. Eight boxes are one vector of lanes, so a node costs about as
 * much as one box. */
#ifndef OCTREE_SHAFT_H
#define OCTREE_SHAFT_H

#include "octree/walk.h"

enum { SHAFT_ENDS = LANES / 2 }; /* points on either side */

/* A slab of the shaft: the points x with low <= n . x <= high hold all end points. */
struct slab {
    lanes low, high; /* the same in all lanes */
};

struct shaft {
    lanes points[3];      /* coordinates of the four starts, then of the four ends */
    struct slab own[3];   /* n = x, y, z */
    struct slab cross[3]; /* n = direction x (x, y, z axis) */
    lanes direction[3];   /* from the mean start to the mean end, largest |.| 1 */
    lanes_mask weights;   /* of the children: bit k for octant k ^ near */
    int near;             /* the nearest octant: bits of the axes it runs down */
};

/* Sets the points. A walk needs their slabs, too. */
void shaft_set_points(struct shaft *shaft, const struct vec3 from[SHAFT_ENDS],
                      const struct vec3 to[SHAFT_ENDS]);
void shaft_set_slabs(struct shaft *shaft);

/* By how much boxes are beyond the slab of an axis, if above 0. Numbers, since AVX-512
 * keeps masks apart, where to join six takes longer than to compare (gcc 12). */
#define BEYOND_OWN(axis) \
    lanes_max(lanes_sub(lanes_at(node->bound[axis][0]), shaft->own[axis].high), \
              lanes_sub(shaft->own[axis].low, lanes_at(node->bound[axis][1])))

/* direction[j] x_i is largest on one side of a box, and smallest on the other. */
#define MOST(i, j) lanes_mul(shaft->direction[j], lanes_at(node->bound[i][up##j]))
#define LEAST(i, j) lanes_mul(shaft->direction[j], lanes_at(node->bound[i][!up##j]))

/* By how much boxes are beyond the slab of an axis's cross product with the direction,
 * which lies across the axes i and j. */
#define BEYOND_CROSS(axis, i, j) \
    lanes_max(lanes_sub(lanes_sub(LEAST(i, j), MOST(j, i)), shaft->cross[axis].high), \
              lanes_sub(shaft->cross[axis].low, lanes_sub(MOST(i, j), LEAST(j, i))))

/* Children whose boxes the shaft may meet. */
INLINE unsigned shaft_enters(const void *beam, const struct node *node,
                             float enter[LANES])
{
    const struct shaft *shaft = beam;
    int up0 = ~shaft->near & 1, up1 = ~shaft->near >> 1 & 1, up2 = ~shaft->near >> 2 & 1;
    lanes own0 = BEYOND_OWN(0), own1 = BEYOND_OWN(1), own2 = BEYOND_OWN(2);
    lanes cross0 = BEYOND_CROSS(0, 1, 2), cross1 = BEYOND_CROSS(1, 2, 0);
    lanes cross2 = BEYOND_CROSS(2, 0, 1);
    lanes own = lanes_max(lanes_max(own0, own1), own2);
    lanes cross = lanes_max(lanes_max(cross0, cross1), cross2);
    lanes_mask in = lanes_upto(lanes_max(own, cross), lanes_all(0.0f));
    (void)enter; /* a shaft goes on to its end */
    return mask_select(&in, &shaft->weights);
}

/* Goes down wherever the shaft may be, to the nearest box first. */
INLINE bool shaft_walk(const struct tree *tree, const struct shaft *shaft,
                       leaf_visit *visit, void *query, struct octree_counts *counts)
{
    return tree_walk(tree, shaft_enters, shaft, shaft->near, NULL, visit, query, counts);
}

#endif
