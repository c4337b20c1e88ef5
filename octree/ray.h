/* One ray on its way down a tree; for octree/ only.
 *
 * A ray is the segment x = origin + t step, 0 <= t <= 1. The ray enters a box at the
 * largest of the three t of entry into the box's slabs, and leaves at the smallest t of
 * exit. Which side of a slab comes first depends on the ray alone. Boxes are BOX_MARGIN
 * wider than their triangles, more than all rounding in these tests.
 *
 * The point where a ray crosses a triangle's plane is computed in double, as in
 * geom/triangle.c. Float decides whether this point is inside of the triangle. Of a step
 * of at most 2.5 the point loses 20 x 2^-24 in float, and 2 x 2^-24 in double where the
 * ray's ends differ by at least CHANGE_LEAST in distance from the plane. A map of error e
 * has a gradient below 2^20 e (octree/build.c): 1.4 e, and with the map's own error 2.5
 * e. Queries decide in double the points nearer to an edge, and rays that graze the
 * plane. */
#ifndef OCTREE_RAY_H
#define OCTREE_RAY_H

#include <string.h>

#include "octree/walk.h"

struct ray {
    struct vec3 from, to;
    float origin[3], step[3];
    float inverse[3]; /* 1 / step; of a step below STEP_LEAST, 1 / STEP_LEAST */
    float reach;      /* t up to which boxes are of use */
    int near;         /* the nearest octant: bits of the axes the ray runs down */
};

static const float STEP_LEAST = 1e-12f;
static const double CHANGE_LEAST = 1e-8;

/* One axis after the other, without a loop: a choice of components by number is a branch,
 * costlier than the arithmetic. */
INLINE void ray_set_axis(struct ray *ray, int axis, double from, double to)
{
    float a = (float)from, step = (float)to - a, size = fabsf(step);
    float inverse = 1.0f / (size > STEP_LEAST ? size : STEP_LEAST);
    ray->near |= (signbit(step) != 0) << axis;
    ray->origin[axis] = a;
    ray->step[axis] = step;
    ray->inverse[axis] = copysignf(inverse, step);
}

INLINE void ray_set(struct ray *ray, struct vec3 from, struct vec3 to)
{
    ray->from = from;
    ray->to = to;
    ray->near = 0;
    ray->reach = 1.0f;
    ray_set_axis(ray, 0, from.x, to.x);
    ray_set_axis(ray, 1, from.y, to.y);
    ray_set_axis(ray, 2, from.z, to.z);
}

/* Cuts the ray to a segment ending behind the scene and beginning no further from the
 * scene than its own size, so that a camera far away keeps its digits. False if the ray
 * misses. */
INLINE bool ray_clip(const struct octree *octree, struct vec3 *origin,
                     struct vec3 direction, struct vec3 *end)
{
    double radius = octree->radius;
    struct vec3 d = vec3_unit(direction);
    double along = vec3_dot(vec3_sub(octree->middle, *origin), d), begin = along - radius;
    if (along + radius <= 0.0)
        return false;
    *end = vec3_add(*origin, vec3_scale(d, along + radius));
    if (begin > 0.0)
        *origin = vec3_add(*origin, vec3_scale(d, begin));
    struct vec3 nearest = vec3_add(*origin, vec3_scale(d, begin > 0.0 ? radius : along));
    struct vec3 aside = vec3_sub(nearest, octree->middle);
    return vec3_dot(aside, aside) <= radius * radius;
}

/* --- boxes --- */

/* t at a side of the boxes' slabs across an axis. */
#define SLAB_AT(axis, side) \
    lanes_mul(lanes_all(ray->inverse[axis]), \
              lanes_sub(lanes_at(node->bound[axis][side]), lanes_all(ray->origin[axis])))

/* Says which children's boxes the ray, whose nearest octant is `near`, may meet within
 * its reach, and where each is entered. */
INLINE void ray_boxes(const struct ray *ray, int near, const struct node *node,
                      lanes_mask *met, lanes *enter)
{
    int x = near & 1, y = near >> 1 & 1, z = near >> 2;
    lanes n0 = SLAB_AT(0, x), f0 = SLAB_AT(0, x ^ 1);
    lanes n1 = SLAB_AT(1, y), f1 = SLAB_AT(1, y ^ 1);
    lanes n2 = SLAB_AT(2, z), f2 = SLAB_AT(2, z ^ 1);
    lanes zero = lanes_all(0.0f), most = lanes_all(ray->reach);
    lanes near2 = lanes_max(n2, zero), far2 = lanes_min(f2, most);
    lanes near01 = lanes_max(n0, n1), far01 = lanes_min(f0, f1);
    lanes first = lanes_max(near01, near2), last = lanes_min(far01, far2);
    *met = lanes_upto(first, last);
    *enter = first;
}

/* The same for a walk. */
INLINE unsigned ray_enters(const void *beam, const struct node *node, float enter[LANES])
{
    const struct ray *ray = beam;
    lanes_mask met, weights;
    lanes first;
    ray_boxes(ray, ray->near, node, &met, &first);
    mask_set_weights(&weights, ray->near);
    if (enter)
        memcpy(enter, &first, LANES * sizeof *enter);
    return mask_select(&met, &weights);
}

/* Goes down along the ray, to the nearest box first. Visits may shorten `*reach`, the
 * ray's; NULL: visits do not. */
INLINE bool ray_walk(const struct tree *tree, const struct ray *ray, const float *reach,
                     leaf_visit *visit, void *query, struct octree_counts *counts)
{
    return tree_walk(tree, ray_enters, ray, ray->near, reach, visit, query, counts);
}

/* --- triangles --- */

/* Signed distances of a ray's ends from the plane of a triangle. */
struct ends {
    double from, to;
};

INLINE struct ends ends_of(const struct ray *ray, const struct record *r)
{
    return (struct ends){plane_distance(&r->plane, ray->from),
                         plane_distance(&r->plane, ray->to)};
}

/* The verdict of float on a ray's line and a triangle. */
enum passage { MISSES, MAY_MEET, MEETS };

/* The line crosses the triangle's plane at t. */
INLINE enum passage ray_passes(const struct ray *ray, const struct record *r,
                               struct ends ends, double at)
{
    const float *o = ray->origin, *d = ray->step, t = (float)at;
    float x[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
    float u = map_at(r->u, x), v = map_at(r->v, x), w = 1.0f - (u + v);
    float eu = 4.0f * r->error_u, ev = 4.0f * r->error_v, ew = eu + ev;
    if (fabs(ends.from - ends.to) <= CHANGE_LEAST)
        return MAY_MEET;
    if ((u < -eu) | (v < -ev) | (w < -ew))
        return MISSES;
    return ((u > eu) & (v > ev) & (w > ew)) ? MEETS : MAY_MEET;
}

#endif
