/* The convex hull of two triangles, cut off at their planes, as half spaces.
 *
 * Its sides are among the planes through an edge of one and a corner of the other, 18 in
 * all: the planes with all six corners on one side. Whether a triangle enters is decided
 * by cutting it with all planes in turn (Sutherland and Hodgman): exact up to rounding,
 * whatever its place. */
#include "geom/hull.h"

static void add_plane(struct hull *hull, struct vec3 normal, double offset)
{
    hull->planes[hull->count++] = (struct plane){normal, offset};
}

/* The planes through an edge of p and a corner of q with all of both on one side. Swapped
 * arguments give the planes through an edge of q. */
static void add_sides(struct hull *hull, const struct triangle *p,
                      const struct triangle *q)
{
    for (int edge = 0; edge < 3; edge++)
        for (int corner = 0; corner < 3; corner++) {
            struct vec3 a = p->corner[edge], b = p->corner[(edge + 1) % 3];
            struct vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(q->corner[corner], a));
            double length = vec3_length(n);
            if (!(length > 0.0))
                continue;
            struct plane out = {vec3_scale(n, 1.0 / length), 0.0};
            out.offset = vec3_dot(out.normal, a);
            struct plane in = {vec3_scale(out.normal, -1.0), -out.offset};
            if (triangle_reach(p, &out) <= GEOM_ROUNDING &&
                triangle_reach(q, &out) <= GEOM_ROUNDING)
                add_plane(hull, out.normal, out.offset);
            else if (triangle_reach(p, &in) <= GEOM_ROUNDING &&
                     triangle_reach(q, &in) <= GEOM_ROUNDING)
                add_plane(hull, in.normal, in.offset);
        }
}

enum { CLIPPED = 3 + 2 + 18 }; /* corners of a triangle after cutting by all planes */

/* Keeps the part behind the plane by more than rounding. Returns the corners left. */
static int cut(const struct vec3 *corners, int count, const struct plane *plane,
               struct vec3 *left)
{
    int kept = 0;
    for (int k = 0; k < count; k++) {
        struct vec3 x = corners[k], y = corners[(k + 1) % count];
        double a = -GEOM_ROUNDING - plane_distance(plane, x);
        double b = -GEOM_ROUNDING - plane_distance(plane, y);
        if (a > 0.0)
            left[kept++] = x;
        if ((a > 0.0) != (b > 0.0))
            left[kept++] = vec3_add(x, vec3_scale(vec3_sub(y, x), a / (a - b)));
    }
    return kept;
}

struct hull hull_of_pair(const struct triangle *p, const struct plane *plane_p,
                         const struct triangle *q, const struct plane *plane_q)
{
    struct hull hull = {.count = 0};
    add_plane(&hull, vec3_scale(plane_p->normal, -1.0), -plane_p->offset);
    add_plane(&hull, vec3_scale(plane_q->normal, -1.0), -plane_q->offset);
    add_sides(&hull, p, q);
    add_sides(&hull, q, p);
    return hull;
}

bool hull_is_entered(const struct hull *hull, const struct triangle *t)
{
    struct vec3 one[CLIPPED], other[CLIPPED], *corners = one, *left = other;
    int count = 3;
    for (int k = 0; k < 3; k++)
        corners[k] = t->corner[k];
    for (int i = 0; i < hull->count && count > 0; i++) {
        count = cut(corners, count, &hull->planes[i], left);
        struct vec3 *done = corners;
        corners = left;
        left = done;
    }
    return count > 0;
}
