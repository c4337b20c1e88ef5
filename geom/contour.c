/* Exchange areas by two integrals: of near pairs, and of far pairs.
 *
 * Near pairs. By Stokes' theorem, used once on each polygon (Sparrow 1963),
 *
 *     G = 1 / (4 pi) sum over edges e of a, g of b  (e . g) integral over e of I_g(x) dt,
 *     I_g(x) = integral over g of ln r^2 ds = s1 ln r1^2 - s0 ln r0^2 - 2 L + 2 h theta,
 *
 * e and g of unit length, L the length of g, r0 and r1 the distances of its ends from x,
 * s0 and s1 their places along g seen from the foot of x, h the distance of x from the
 * line of g and theta the angle at x between the ends. The inner integral is exact even
 * where x lies on g. The outer one is taken by Gauss' rule on panels. I_g is analytic in
 * t but for branch points in the complex plane: at t* +- i d, where d is the distance of
 * an end of g from the line of e and t* its foot there; and where e and g pass each
 * other, with d their distance over the sine of the angle. Panels are cut until the
 * ellipse through the nearest branch point is wide enough for 16 points to give all
 * digits, so that shared edges, parts of edges, corners in edges and narrow gaps are one
 * case: panels that shrink towards a point by a factor of five each. At the point itself
 * I_g is like t ln t, so that a panel of 1e-6 of the edge adds 1e-14 and may be wrong.
 *
 * Far pairs. The terms above cancel. If the smaller polygon p is farther from the edges
 * of the other one, q, than 2.5 times its radius,
 *
 *     G = integral over p of F(x, q) dA,
 *
 * F from geom/lambert.h, needs few points: Gauss' rule in both coordinates of
 * quadrilaterals, 4 to 10 points as the distance demands.
 *
 * Both need each polygon in front of the other's plane: parts behind it are cut off
 * first, and corners within rounding of the plane count as on it. Polygons need not be
 * convex; those with many corners are cut into triangles to save memory. So that the
 * order of the arguments and the unit of length do not matter, the polygons are sorted,
 * moved to the first corner and scaled by a power of two.
 *
 * Rejected: the closed form of the double integral (Schroeder and Hanrahan 1993), which
 * needs the dilogarithm of complex numbers and care with its branches, and cancels for
 * far pairs, too; adaptive panels by comparing rules, which cost more than panels of
 * known width. */
#include "geom/contour.h"

#include <math.h>
#include <stdbool.h>

#include "geom/alloc.h"
#include "geom/elementary.h"
#include "geom/lambert.h"
#include "geom/polygon.h"
#include "geom/gauss.h"

enum { CORNERS_MAX = 12 }; /* of a shape; polygons with more are cut into triangles */

/* A polygon, with room for the corners that a cut adds: one for each edge at most. */
struct shape {
    int32_t count;
    struct vec3 corner[2 * CORNERS_MAX];
};

/* --- shapes --- */

/* Returns the normal towards the front, of a length of twice the area. */
static struct vec3 area_vector(const struct vec3 *corners, int32_t count)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int32_t k = 1; k + 1 < count; k++)
        sum = vec3_add(sum, vec3_cross(vec3_sub(corners[k], corners[0]),
                                       vec3_sub(corners[k + 1], corners[0])));
    return sum;
}

double polygon_area(const struct vec3 *corners, int32_t count)
{
    return 0.5 * vec3_length(area_vector(corners, count));
}

static double shape_area(const struct shape *shape)
{
    return polygon_area(shape->corner, shape->count);
}

static struct vec3 shape_centre(const struct shape *shape)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < shape->count; k++)
        sum = vec3_add(sum, shape->corner[k]);
    return vec3_scale(sum, 1.0 / shape->count);
}

static double shape_radius(const struct shape *shape)
{
    struct vec3 centre = shape_centre(shape);
    double radius = 0.0;
    for (int32_t k = 0; k < shape->count; k++)
        radius = fmax(radius, vec3_length(vec3_sub(shape->corner[k], centre)));
    return radius;
}

/* Keeps the part in front of the plane through `foot`; corners within rounding are on it.
 * Leaves no corners if no part is in front. Several pieces are joined by edges along the
 * plane, there and back, which cancel in the sum. */
static void cut_behind(struct shape *shape, struct vec3 normal, struct vec3 foot)
{
    struct shape old = *shape;
    double height[2 * CORNERS_MAX];
    bool any = false;
    for (int32_t k = 0; k < old.count; k++) {
        height[k] = vec3_dot(normal, vec3_sub(old.corner[k], foot));
        if (fabs(height[k]) <= GEOM_ROUNDING)
            height[k] = 0.0;
        any = any || height[k] > 0.0;
    }
    shape->count = 0;
    for (int32_t k = 0; k < old.count && any; k++) {
        int32_t next = k + 1 < old.count ? k + 1 : 0;
        struct vec3 from = old.corner[k], to = old.corner[next];
        if (height[k] >= 0.0)
            shape->corner[shape->count++] = from;
        if (!(height[k] * height[next] < 0.0))
            continue;
        double t = height[k] / (height[k] - height[next]);
        struct vec3 along = vec3_scale(vec3_sub(to, from), t);
        shape->corner[shape->count++] = vec3_add(from, along);
    }
}

/* Keeps the part of each in front of the other's plane. False if there is none. */
static bool cut_each_other(struct shape *a, struct shape *b)
{
    struct vec3 normal_a = area_vector(a->corner, a->count), foot_a = a->corner[0];
    struct vec3 normal_b = area_vector(b->corner, b->count), foot_b = b->corner[0];
    double twice_a = vec3_length(normal_a), twice_b = vec3_length(normal_b);
    if (!(twice_a > 0.0) || !(twice_b > 0.0))
        return false;
    cut_behind(a, vec3_scale(normal_b, 1.0 / twice_b), foot_b);
    cut_behind(b, vec3_scale(normal_a, 1.0 / twice_a), foot_a);
    return a->count >= 3 && b->count >= 3;
}

/* --- far pairs --- */

static double segment_distance(struct vec3 x, struct vec3 from, struct vec3 to)
{
    struct vec3 edge = vec3_sub(to, from), r = vec3_sub(x, from);
    double length2 = vec3_dot(edge, edge);
    double t = length2 > 0.0 ? vec3_dot(r, edge) / length2 : 0.0;
    return vec3_length(vec3_sub(r, vec3_scale(edge, fmax(0.0, fmin(1.0, t)))));
}

/* Returns the distance of a point from the nearest edge of a shape: F(x, shape) is
 * singular at the edges, and as smooth near the middle of the shape as far away. */
static double edge_distance(const struct shape *shape, struct vec3 x)
{
    double nearest = HUGE_VAL;
    for (int32_t k = 0; k < shape->count; k++) {
        struct vec3 from = shape->corner[k],
                    to = shape->corner[k + 1 < shape->count ? k + 1 : 0];
        nearest = fmin(nearest, segment_distance(x, from, to));
    }
    return nearest;
}

/* Integrates F(x, q) over the quadrilateral c[0..3], by a rule in both of its
 * coordinates; the third and the fourth corner may be the same. Negative if it is
 * clockwise. */
static double integrate_quadrilateral(const struct vec3 c[4], struct vec3 normal,
                                      const struct shape *q, const struct gauss *rule)
{
    struct vec3 u = vec3_sub(c[1], c[0]), v = vec3_sub(c[3], c[0]);
    struct vec3 twist = vec3_add(vec3_sub(c[2], c[1]), vec3_sub(c[0], c[3]));
    double sum = 0.0;
    for (int k = 0; k < 4 * rule->pairs * rule->pairs; k++) {
        double weight_s, weight_t;
        double s = gauss_point(rule, k % (2 * rule->pairs), &weight_s);
        double t = gauss_point(rule, k / (2 * rule->pairs), &weight_t);
        struct vec3 along_s = vec3_add(u, vec3_scale(twist, t));
        struct vec3 along_t = vec3_add(v, vec3_scale(twist, s));
        double area = vec3_dot(normal, vec3_cross(along_s, along_t));
        struct vec3 x =
            vec3_add(c[0], vec3_add(vec3_scale(along_s, s), vec3_scale(v, t)));
        sum += weight_s * weight_t * area *
               point_polygon_factor(x, normal, q->corner, q->count);
    }
    return sum;
}

/* Integrates over p as a fan of quadrilaterals. If p is not convex, some overlap and some
 * are negative. */
static double integrate_points(const struct shape *p, const struct shape *q, int points)
{
    struct gauss rule = gauss_rule(points);
    struct vec3 normal = area_vector(p->corner, p->count);
    normal = vec3_unit(normal);
    double sum = 0.0;
    for (int32_t k = 1; k + 1 < p->count; k += 2) {
        int32_t last = k + 2 < p->count ? k + 2 : k + 1;
        const struct vec3 c[4] = {p->corner[0], p->corner[k], p->corner[k + 1],
                                  p->corner[last]};
        sum += integrate_quadrilateral(c, normal, q, &rule);
    }
    return sum;
}

/* Returns the points in each direction for 11 digits or more if the nearest singularity
 * of F is `ratio` radii from the centre; 0 if it is too near. */
static int points_for(double ratio)
{
    return ratio >= 20.0 ? 4 : ratio >= 6.0 ? 6 : ratio >= 2.5 ? 10 : 0;
}

/* --- near pairs --- */

/* An edge with its direction and length. */
struct edge {
    struct vec3 from, to, along;
    double length;
};

static struct edge edge_of(const struct shape *shape, int32_t k)
{
    struct edge edge = {.from = shape->corner[k],
                        .to = shape->corner[k + 1 < shape->count ? k + 1 : 0]};
    struct vec3 d = vec3_sub(edge.to, edge.from);
    edge.length = vec3_length(d);
    if (edge.length > 0.0)
        edge.along = vec3_scale(d, 1.0 / edge.length);
    return edge;
}

/* Returns s ln r^2, whose limit is 0. */
static double end_term(double s, double r2)
{
    return r2 > 0.0 ? s * logarithm(r2) : 0.0;
}

/* Integrates ln r^2 over the edge g, with r the distance from x. */
static double logarithm_over(const struct edge *g, struct vec3 x)
{
    struct vec3 r0 = vec3_sub(g->from, x), r1 = vec3_sub(g->to, x);
    double square0 = vec3_dot(r0, r0), square1 = vec3_dot(r1, r1);
    double h = vec3_length(vec3_cross(square0 < square1 ? r0 : r1, g->along));
    double theta = arctangent(h * g->length, vec3_dot(r0, r1));
    return end_term(vec3_dot(r1, g->along), square1) -
           end_term(vec3_dot(r0, g->along), square0) - 2.0 * g->length + 2.0 * h * theta;
}

/* A branch point of the inner integral, at + i off along the outer edge. */
struct branch {
    double at, off;
};

enum { BRANCHES = 3 };

static struct branch branch_at_end(const struct edge *e, struct vec3 end)
{
    struct vec3 r = vec3_sub(end, e->from);
    return (struct branch){vec3_dot(r, e->along), vec3_length(vec3_cross(r, e->along))};
}

/* Returns the branch point where the lines of the edges pass each other; far off if they
 * are parallel. */
static struct branch branch_at_crossing(const struct edge *e, const struct edge *g)
{
    struct vec3 cross = vec3_cross(e->along, g->along), r = vec3_sub(g->from, e->from);
    double sine2 = vec3_dot(cross, cross);
    if (sine2 < 1e-20)
        return (struct branch){0.0, HUGE_VAL};
    double at = vec3_dot(vec3_cross(r, g->along), cross) / sine2;
    return (struct branch){at, fabs(vec3_dot(r, cross)) / sine2};
}

/* Returns the sum of the distances of the branch point from the ends of a panel, in
 * widths of the panel. */
static double clearance(const struct branch *branch, double from, double to)
{
    double a = from - branch->at, b = to - branch->at, off2 = branch->off * branch->off;
    return (sqrt(a * a + off2) + sqrt(b * b + off2)) / (to - from);
}

static double integrate_panel(const struct edge *e, const struct edge *g, double from,
                              double to, int points)
{
    struct gauss rule = gauss_rule(points);
    double sum = 0.0;
    for (int k = 0; k < 2 * rule.pairs; k++) {
        double weight, t = from + (to - from) * gauss_point(&rule, k, &weight);
        sum += weight * logarithm_over(g, vec3_add(e->from, vec3_scale(e->along, t)));
    }
    return sum * (to - from);
}

/* Clearances from which 16 and 10 points give 13 digits. */
static const double CLEAR_16 = 1.5, CLEAR_10 = 2.5;

static const double SHORTEST = 1e-6; /* part of an edge that is not cut further */

/* Returns the place to cut a panel: at the branch point, but at least a fifth from both
 * ends. */
static double cut_for(const struct branch *branch, double from, double to)
{
    double width = to - from;
    return fmin(fmax(branch->at, from + 0.2 * width), to - 0.2 * width);
}

static double integrate_edge(const struct edge *e, const struct edge *g,
                             const struct branch *branches, double from, double to)
{
    const struct branch *worst = &branches[0];
    for (int k = 1; k < BRANCHES; k++)
        if (clearance(&branches[k], from, to) < clearance(worst, from, to))
            worst = &branches[k];
    double clear = clearance(worst, from, to);
    if (clear >= CLEAR_16 || !(to - from > SHORTEST * e->length))
        return integrate_panel(e, g, from, to, clear >= CLEAR_10 ? 10 : 16);
    double cut = cut_for(worst, from, to);
    return integrate_edge(e, g, branches, from, cut) +
           integrate_edge(e, g, branches, cut, to);
}

static double integrate_edges(const struct edge *e, const struct edge *g)
{
    double cosine = vec3_dot(e->along, g->along);
    if (cosine == 0.0)
        return 0.0;
    const struct branch branches[BRANCHES] = {
        branch_at_end(e, g->from), branch_at_end(e, g->to), branch_at_crossing(e, g)};
    return cosine * integrate_edge(e, g, branches, 0.0, e->length);
}

static double integrate_contours(const struct shape *a, const struct shape *b)
{
    double sum = 0.0;
    for (int32_t i = 0; i < a->count; i++) {
        struct edge e = edge_of(a, i);
        for (int32_t j = 0; j < b->count; j++) {
            struct edge g = edge_of(b, j);
            bool first = e.length < g.length;
            if (e.length > 0.0 && g.length > 0.0)
                sum += integrate_edges(first ? &e : &g, first ? &g : &e);
        }
    }
    return sum / (4.0 * PI);
}

/* --- pairs --- */

/* Returns the exchange of shapes in the unit cube, which it cuts. */
static double exchange_of_shapes(struct shape *a, struct shape *b)
{
    if (!cut_each_other(a, b))
        return 0.0;
    bool first = shape_radius(a) <= shape_radius(b);
    const struct shape *p = first ? a : b, *q = first ? b : a;
    int points = points_for(edge_distance(q, shape_centre(p)) / shape_radius(p));
    double exchange =
        points > 0 ? integrate_points(p, q, points) : integrate_contours(a, b);
    return fmax(0.0, fmin(exchange, fmin(shape_area(a), shape_area(b))));
}

/* A polygon of the caller and its triangles. */
struct parts {
    const struct vec3 *corners;
    int32_t count;      /* corners */
    int32_t parts;      /* triangles; 1: the whole polygon */
    int32_t *triangles; /* owned, [3 * parts] corner numbers, or NULL */
};

static struct parts parts_create(const struct vec3 *corners, int32_t count)
{
    struct parts parts = {corners, count, 1, NULL};
    if (count <= CORNERS_MAX)
        return parts;
    parts.parts = count - 2;
    parts.triangles = alloc_array(3 * (size_t)parts.parts, sizeof *parts.triangles);
    polygon_triangulate(corners, count, parts.triangles);
    return parts;
}

/* Returns part k, moved and scaled. */
static struct shape part_shape(const struct parts *parts, int32_t k, struct vec3 origin,
                               double scale)
{
    struct shape shape = {.count = parts->triangles ? 3 : parts->count};
    for (int32_t i = 0; i < shape.count; i++) {
        int32_t corner = parts->triangles ? parts->triangles[3 * k + i] : i;
        shape.corner[i] = vec3_scale(vec3_sub(parts->corners[corner], origin), scale);
    }
    return shape;
}

/* Returns the largest coordinate of a polygon relative to `origin`. */
static double extent_of(const struct vec3 *corners, int32_t count, struct vec3 origin)
{
    double extent = 0.0;
    for (int32_t k = 0; k < count; k++) {
        struct vec3 r = vec3_sub(corners[k], origin);
        extent = fmax(extent, fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z))));
    }
    return extent;
}

/* Compares polygons: below 0 if a is first in the order, 0 if they are equal. */
static int compare_polygons(const struct vec3 *a, int32_t count_a, const struct vec3 *b,
                            int32_t count_b)
{
    if (count_a != count_b)
        return count_a < count_b ? -1 : 1;
    for (int32_t k = 0; k < 3 * count_a; k++) {
        double x = vec3_axis(a[k / 3], k % 3), y = vec3_axis(b[k / 3], k % 3);
        if (x != y)
            return x < y ? -1 : 1;
    }
    return 0;
}

static double exchange_of_parts(const struct parts *a, const struct parts *b)
{
    if (compare_polygons(a->corners, a->count, b->corners, b->count) > 0)
        return exchange_of_parts(b, a);
    struct vec3 origin = a->corners[0];
    int exponent;
    frexp(fmax(extent_of(a->corners, a->count, origin),
               extent_of(b->corners, b->count, origin)), &exponent);
    double scale = ldexp(1.0, -exponent), sum = 0.0;
    for (int32_t i = 0; i < a->parts; i++)
        for (int32_t j = 0; j < b->parts; j++) {
            struct shape shape_a = part_shape(a, i, origin, scale);
            struct shape shape_b = part_shape(b, j, origin, scale);
            sum += exchange_of_shapes(&shape_a, &shape_b);
        }
    double limit =
        fmin(polygon_area(a->corners, a->count), polygon_area(b->corners, b->count));
    return fmin(sum / (scale * scale), limit);
}

double polygon_exchange(const struct vec3 *a, int32_t count_a, const struct vec3 *b,
                        int32_t count_b)
{
    struct parts parts_a = parts_create(a, count_a), parts_b = parts_create(b, count_b);
    double area = exchange_of_parts(&parts_a, &parts_b);
    alloc_free(parts_a.triangles);
    alloc_free(parts_b.triangles);
    return area;
}

double triangle_exchange(const struct triangle *a, const struct triangle *b)
{
    struct parts whole_a = {.corners = a->corner, .count = 3, .parts = 1};
    struct parts whole_b = {.corners = b->corner, .count = 3, .parts = 1};
    return exchange_of_parts(&whole_a, &whole_b);
}
