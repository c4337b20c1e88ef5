/* Triangles: area, normal, subdivision, and the segment test for visibility. */
#ifndef GEOM_TRIANGLE_H
#define GEOM_TRIANGLE_H

#include <stdbool.h>

#include "geom/vec.h"

/* A distance (scene units, where the scene fits in the unit cube) below which rounding,
 * and not the input, decides on which side of a plane a point lies: 64 units in the last
 * place. */
#define GEOM_ROUNDING 1.4210854715202004e-14

struct triangle {
    struct vec3 corner[3]; /* counter-clockwise seen from the front */
};

struct plane {
    struct vec3 normal; /* unit length, towards the front */
    double offset;      /* normal . x of the points x of the plane */
};

/* Segment or ray prepared for the watertight test: coordinates are sheared to make the
 * direction the third axis. */
struct segment {
    struct vec3 from, to;
    int axis[3];     /* order of the coordinates; |to - from| is largest on axis[2] */
    double shear[2]; /* taken off the first two coordinates per unit of the third */
};

struct vec3 triangle_cross(const struct triangle *t);   /* normal times twice the area */
double triangle_area(const struct triangle *t);         /* square scene units */

static inline struct vec3 triangle_centroid(const struct triangle *t)
{
    struct vec3 sum = vec3_add(vec3_add(t->corner[0], t->corner[1]), t->corner[2]);
    return vec3_scale(sum, 1.0 / 3.0);
}

/* Largest, corner to centroid. */
static inline double triangle_radius(const struct triangle *t)
{
    struct vec3 centre = triangle_centroid(t);
    double a = vec3_length(vec3_sub(t->corner[0], centre));
    double b = vec3_length(vec3_sub(t->corner[1], centre));
    return real_max(a, real_max(b, vec3_length(vec3_sub(t->corner[2], centre))));
}

/* The corners of the box around the triangle. */
static inline struct vec3 triangle_low(const struct triangle *t)
{
    return vec3_least(t->corner[0], vec3_least(t->corner[1], t->corner[2]));
}

static inline struct vec3 triangle_high(const struct triangle *t)
{
    return vec3_most(t->corner[0], vec3_most(t->corner[1], t->corner[2]));
}

/* Three points; for polynomials of degree 2 the mean over these is the mean over the
 * triangle (Stroud's formula of degree 2): the barycentric coordinates of point k are 2/3
 * for corner k, and 1/6. */
static inline void triangle_three_points(const struct triangle *t, struct vec3 x[3])
{
    const struct vec3 *c = t->corner;
    struct vec3 sixth = vec3_scale(vec3_add(vec3_add(c[0], c[1]), c[2]), 1.0 / 6.0);
    for (int k = 0; k < 3; k++)
        x[k] = vec3_add(sixth, vec3_scale(c[k], 0.5));
}

/* The mean of three corners, or of their normals, with the weights x, y and z: the point
 * with these barycentric coordinates. */
static inline struct vec3 corners_mean(const struct vec3 corner[3],
                                       struct vec3 weight)
{
    struct vec3 a = vec3_scale(corner[0], weight.x), b = vec3_scale(corner[1], weight.y);
    return vec3_add(vec3_add(a, b), vec3_scale(corner[2], weight.z));
}

/* The triangle with the corners (a, c, b), which faces the other way. */
static inline struct triangle triangle_turned(const struct triangle *t)
{
    return (struct triangle){{t->corner[0], t->corner[2], t->corner[1]}};
}

/* Pre: the area is not zero. */
struct plane triangle_plane(const struct triangle *t);

/* True where the corners lie on a line within rounding. */
bool triangle_is_degenerate(const struct triangle *t);

/* Child 0..3 of the quadtree split: 0 = (a, ab, ca), 1 = (ab, b, bc), 2 = (ca, bc, c) and
 * 3 = (bc, ca, ab). Two triangles with a common edge split it at the same bits. */
static inline struct triangle triangle_child(const struct triangle *t, int child)
{
    struct vec3 a = t->corner[0], b = t->corner[1], c = t->corner[2];
    struct vec3 ab = vec3_middle(a, b), bc = vec3_middle(b, c), ca = vec3_middle(c, a);
    switch (child) {
    case 0: return (struct triangle){{a, ab, ca}};
    case 1: return (struct triangle){{ab, b, bc}};
    case 2: return (struct triangle){{ca, bc, c}};
    default: return (struct triangle){{bc, ca, ab}};
    }
}

/* The barycentric coordinates `w` of a point in the plane of a triangle. */
static inline void triangle_weights(const struct triangle *t, struct vec3 x, double w[3])
{
    struct vec3 a = vec3_sub(t->corner[1], t->corner[0]);
    struct vec3 b = vec3_sub(t->corner[2], t->corner[0]);
    struct vec3 to = vec3_sub(x, t->corner[0]), normal = vec3_cross(a, b);
    double unit = 1.0 / vec3_dot(normal, normal);
    w[1] = vec3_dot(vec3_cross(to, b), normal) * unit;
    w[2] = vec3_dot(vec3_cross(a, to), normal) * unit;
    w[0] = 1.0 - w[1] - w[2];
}

/* Turns barycentric coordinates in a triangle into those in the child with the point.
 * Returns the number of the child. */
static inline int triangle_child_at(double w[3])
{
    int child = w[0] >= 0.5 ? 0 : w[1] >= 0.5 ? 1 : w[2] >= 0.5 ? 2 : 3;
    for (int k = 0; k < 3; k++)
        w[k] *= 2.0;
    if (child < 3)
        w[child] -= 1.0;
    for (int k = 0; k < 3 && child == 3; k++)
        w[k] = 1.0 - w[k];
    return child;
}

/* Signed distance to the plane, positive in front. */
static inline double plane_distance(const struct plane *plane, struct vec3 x)
{
    return vec3_dot(plane->normal, x) - plane->offset;
}

/* How far ahead of x the plane is, in lengths of the direction; 0 along the plane. */
static inline double plane_ahead(const struct plane *plane, struct vec3 x,
                                 struct vec3 direction)
{
    double rise = vec3_dot(plane->normal, direction);
    return rise != 0.0 ? -plane_distance(plane, x) / rise : 0.0;
}

/* The largest distance of a corner in front of the plane; below 0 if all lie behind. */
static inline double triangle_reach(const struct triangle *t, const struct plane *plane)
{
    double a = plane_distance(plane, t->corner[0]);
    double b = plane_distance(plane, t->corner[1]);
    return real_max(a, real_max(b, plane_distance(plane, t->corner[2])));
}

/* True if the triangle lies in the plane, of another one, and faces the same way. `own`:
 * its own plane. */
bool triangle_is_in(const struct triangle *t, const struct plane *own,
                    const struct plane *plane);

/* True if two triangles of a plane, which both face, share more than edges. */
bool triangles_overlap(const struct triangle *s, const struct triangle *t,
                       const struct plane *plane);

/* Pre: from != to. */
struct segment segment_make(struct vec3 from, struct vec3 to);

/* True where the segment's line passes through the closed triangle. Watertight: of the
 * triangles of a closed mesh at least one says yes on each crossing, also through edges
 * and vertices. A line in the triangle's plane misses. `weight`, unless NULL, receives
 * the barycentric coordinates of the point. */
bool segment_line_meets(const struct segment *s, const struct triangle *t,
                        double weight[3]);

/* True where the triangle blocks the segment: its end points lie on opposite sides of the
 * triangle's plane, both off the plane by more than rounding, and the line passes through
 * the triangle. Both sides block. A triangle in whose plane an end point lies does not
 * block: so a decal in a wall, or a light flush with the ceiling, is visible. */
bool segment_is_blocked_by(const struct segment *s, const struct triangle *t,
                           const struct plane *plane);

#endif
