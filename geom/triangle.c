/* Triangles and the watertight segment test.
 *
 * The test follows Woop, Benthin and Wald (Journal of Computer Graphics Techniques 2(1),
 * 2013): coordinates are taken relative to the segment's start, permuted and sheared to
 * turn the segment into the third axis; the three edge functions of the projected
 * triangle then say whether the origin is inside. It is watertight because:
 *
 *  - a vertex is projected to the same bits in each of its triangles;
 *  - an edge function is x1 y2 - x2 y1, so triangles at an edge get exact negatives;
 *  - rounding is monotone, so the sign of that difference is right or zero, not inverted,
 *    and zero counts as inside.
 *
 * So no line slips between two triangles with a common edge. A fused multiply-add would
 * break the second point, which is one more reason for -ffp-contract=off.
 *
 * Rejected: Moeller-Trumbore (each triangle rounds a shared edge for itself, so rays
 * leak) and an absolute epsilon along the ray (wrong for small scenes and at
 * contacts). */
#include "geom/triangle.h"

#include <stddef.h>

/* A triangle is in a plane if no corner is further off than this. */
static const double COPLANAR = 4.0 * GEOM_ROUNDING;

/* Triangles sharing a strip narrower than this part of a side only touch, as those with a
 * corner on the side of another do in a file of six digits. */
static const double TOUCHING = 1e-6;

struct vec3 triangle_cross(const struct triangle *t)
{
    return vec3_cross(vec3_sub(t->corner[1], t->corner[0]),
                      vec3_sub(t->corner[2], t->corner[0]));
}

double triangle_area(const struct triangle *t)
{
    return 0.5 * vec3_length(triangle_cross(t));
}

struct plane triangle_plane(const struct triangle *t)
{
    struct vec3 cross = triangle_cross(t);
    struct plane plane;
    plane.normal = vec3_unit(cross);
    plane.offset = vec3_dot(plane.normal, triangle_centroid(t));
    return plane;
}

bool triangle_is_degenerate(const struct triangle *t)
{
    double longest = 0.0;
    for (int k = 0; k < 3; k++) {
        double edge = vec3_length(vec3_sub(t->corner[(k + 1) % 3], t->corner[k]));
        longest = edge > longest ? edge : longest;
    }
    return 2.0 * triangle_area(t) <= GEOM_ROUNDING * longest; /* its height is noise */
}

bool triangle_is_in(const struct triangle *t, const struct plane *own,
                    const struct plane *plane)
{
    double off = 0.0;
    for (int k = 0; k < 3; k++)
        off = real_max(off, fabs(plane_distance(plane, t->corner[k])));
    return off <= COPLANAR && vec3_dot(plane->normal, own->normal) > 0.0;
}

/* True if a side of s has all of t on its outside, or all but a narrow strip. */
static bool has_side_before(const struct triangle *s, const struct triangle *t,
                            const struct plane *plane)
{
    bool found = false;
    for (int k = 0; k < 3 && !found; k++) {
        struct vec3 side = vec3_sub(s->corner[(k + 1) % 3], s->corner[k]);
        struct vec3 out = vec3_cross(side, plane->normal);
        double least = -TOUCHING * vec3_dot(out, out);
        found = true;
        for (int j = 0; j < 3; j++)
            found = found && vec3_dot(out, vec3_sub(t->corner[j], s->corner[k])) >= least;
    }
    return found;
}

bool triangles_overlap(const struct triangle *s, const struct triangle *t,
                       const struct plane *plane)
{
    return !has_side_before(s, t, plane) && !has_side_before(t, s, plane);
}

struct segment segment_make(struct vec3 from, struct vec3 to)
{
    struct segment s = {.from = from, .to = to};
    struct vec3 d = vec3_sub(to, from);
    double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    int larger = x > y ? 0 : 1, largest = (x > y ? x : y) > z ? larger : 2;
    s.axis[0] = (largest + 1) % 3;
    s.axis[1] = (largest + 2) % 3;
    s.axis[2] = largest;
    s.shear[0] = vec3_axis(d, s.axis[0]) / vec3_axis(d, largest);
    s.shear[1] = vec3_axis(d, s.axis[1]) / vec3_axis(d, largest);
    return s;
}

bool segment_line_meets(const struct segment *s, const struct triangle *t,
                        double weight[3])
{
    double x[3], y[3];
    for (int k = 0; k < 3; k++) {
        struct vec3 c = vec3_sub(t->corner[k], s->from);
        const double v[3] = {c.x, c.y, c.z};
        double z = v[s->axis[2]];
        x[k] = v[s->axis[0]] - s->shear[0] * z;
        y[k] = v[s->axis[1]] - s->shear[1] * z;
    }
    double u = x[1] * y[2] - x[2] * y[1];
    double v = x[2] * y[0] - x[0] * y[2];
    double w = x[0] * y[1] - x[1] * y[0];
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0))
        return false;
    double sum = u + v + w;
    if (sum == 0.0)
        return false;
    if (weight) {
        weight[0] = u / sum;
        weight[1] = v / sum;
        weight[2] = w / sum;
    }
    return true;
}

bool segment_is_blocked_by(const struct segment *s, const struct triangle *t,
                           const struct plane *plane)
{
    double start = plane_distance(plane, s->from);
    double end = plane_distance(plane, s->to);
    bool crosses = (start > GEOM_ROUNDING && end < -GEOM_ROUNDING) ||
                   (start < -GEOM_ROUNDING && end > GEOM_ROUNDING);
    return crosses && segment_line_meets(s, t, NULL);
}
