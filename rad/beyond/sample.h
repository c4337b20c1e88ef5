/* Points on triangles, and rays from there, evenly distributed over seeds. */
#ifndef RAD_BEYOND_SAMPLE_H
#define RAD_BEYOND_SAMPLE_H

#include <stdint.h>

#include "geom/scene.h"
#include "octree/octree.h"
#include "rad/patch.h"

/* A ray: one from a surface begins just above. */
struct half_line {
    struct vec3 origin, direction; /* of length 1 */
};

/* The first of `count` places whose sum, which rises from place to place, exceeds `at`:
 * a choice in proportion to the rises. The last place if none does. */
int64_t sum_place(const double *sums, int64_t count, double at);

/* A point on the triangle. Uses seed and seed + 1. */
struct vec3 triangle_sample(const struct triangle *t, uint64_t seed);

/* Just in front of a point on a surface. */
static inline struct vec3 point_above(struct vec3 point, struct vec3 normal)
{
    return vec3_add(point, vec3_scale(normal, 1024.0 * GEOM_ROUNDING));
}

/* A ray from a point of the triangle's front, distributed as the cosine to its unit
 * normal, in ring `ring` of `rings` equally probable ones from the normal outwards.
 * Uses seed to seed + 4, and more made of these. */
struct half_line ray_sample(const struct triangle *t, struct vec3 normal, uint64_t seed,
                            int ring, int rings);

/* The root whose front the ray meets first; -1 for a back, `outside` for none. */
int32_t root_met(const struct scene *scene, const struct octree *octree,
                 const struct half_line *ray, int32_t outside,
                 struct octree_counts *counts);

/* The leaf of a root at its point with these barycentric coordinates, which become those
 * in the leaf. */
int32_t leaf_at(const struct forest *forest, int32_t root, double weight[3]);

/* The same at a point in space: finds its coordinates. */
int32_t leaf_under(const struct forest *forest, int32_t root, struct vec3 at,
                   double weight[3]);

/* True if a sender's middle is nearer to a point than the sender's radius: rays from the
 * point find such a sender often enough, and no segments are aimed there. */
static inline bool point_is_beside(struct vec3 x, const struct triangle *sender)
{
    struct vec3 apart = vec3_sub(triangle_centroid(sender), x);
    double radius = triangle_radius(sender);
    return vec3_dot(apart, apart) < radius * radius;
}

/* cos cos' / (pi r^2) of the points x and y, 1 per square scene unit, without visibility;
 * 0 below a horizon. */
static inline double point_kernel(struct vec3 x, struct vec3 normal_x, struct vec3 y,
                                  struct vec3 normal_y)
{
    struct vec3 d = vec3_sub(y, x);
    double d2 = vec3_dot(d, d);
    double rise = vec3_dot(normal_x, d), fall = -vec3_dot(normal_y, d);
    return rise > 0.0 && fall > 0.0 ? rise * fall / (PI * d2 * d2) : 0.0;
}

#endif
