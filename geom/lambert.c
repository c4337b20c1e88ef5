/* Lambert's formula, and a quadrature where it cancels.
 *
 * With r_k the corners as seen from the point x, theta_k the angle between r_k and r_k+1
 * and n the normal at x, Lambert (Photometria, 1760) found
 *
 *     F = 1 / (2 pi)  sum over k of  theta_k  n . (r_k+1 x r_k) / |r_k+1 x r_k|,
 *
 * exact for any polygon above the horizon. The angle is arctangent(|r_k x r_k+1|, r_k .
 * r_k+1), right for small, straight and obtuse angles alike; acos of the normalised
 * product loses half of the digits at small angles and leaves its domain by rounding. A
 * triangle cut by the horizon keeps the part above, three or four corners.
 *
 * The terms are of order 1, so each sum is right to some 1e-16, whatever its size. The
 * sum is much smaller than its terms, and most of its digits are lost, for a triangle of
 * size s at a large distance d: F is (s/d)^2. The integral
 *
 *     F = h / pi  integral of  (n . r) / |r|^4  dA,   h the distance of x to the plane,
 *
 * has no cancelling terms. Where s is at most FAR of d the integral is taken by Radon's
 * rule of seven points, exact to degree 5: its error falls with (s/d)^6 and is 3e-10 of F
 * at most, for two thirds of the time of three arctangents. F is then small only where h
 * or n . r are, and so is its error.
 *
 * The sum is small for three more reasons: x close to the plane of the triangle and not
 * over it, a triangle that reaches just above the horizon, a sliver. There the error
 * stays some 1e-16 of the hemisphere and is not a small part of F. Cutting such triangles
 * into far pieces gives all digits, at a hundred to ten thousand times the price; faces
 * in one plane but for the rounding of their file would pay this everywhere, for light
 * that is not there.
 *
 * A point on the plane but for rounding must see nothing: just in front of a triangle
 * facing the point, nothing else would be seen.
 *
 * Rejected: a single point for far triangles, whose error falls with (s/d)^2 only. */
#include "geom/lambert.h"

#include <math.h>
#include <stdbool.h>

#include "geom/elementary.h"

/* Size over distance up to which seven points do. */
static const double FAR = 0.06;

/* A corner as seen from the point. */
struct sight {
    struct vec3 r;
    double rise; /* height above the point's horizon, n . r */
};

static double square(struct vec3 a)
{
    return vec3_dot(a, a);
}

/* n . r / |r|^4 of a point of the polygon. */
static double density(struct vec3 r, double rise)
{
    double r2 = square(r);
    return rise / (r2 * r2);
}

/* The point of barycentric coordinates a, a and 1 - 2 a, the last one at corner k. */
static double density_beside(const struct sight *s, struct vec3 sum, double rises, int k,
                             double a)
{
    double rest = 1.0 - 3.0 * a;
    struct vec3 r = vec3_add(vec3_scale(sum, a), vec3_scale(s[k].r, rest));
    return density(r, a * rises + rest * s[k].rise);
}

/* Mean of the density over the triangle s[0], s[1], s[2] by Radon's rule. */
static double mean_density(const struct sight *s)
{
    static const double INNER = 0.10128650732345634, INNER_WEIGHT = 0.12593918054482714;
    static const double OUTER = 0.4701420641051151, OUTER_WEIGHT = 0.1323941527885062;
    struct vec3 sum = vec3_add(vec3_add(s[0].r, s[1].r), s[2].r);
    double rises = s[0].rise + s[1].rise + s[2].rise;
    double inner = 0.0, outer = 0.0;
    for (int k = 0; k < 3; k++) {
        inner += density_beside(s, sum, rises, k, INNER);
        outer += density_beside(s, sum, rises, k, OUTER);
    }
    double middle = density(vec3_scale(sum, 1.0 / 3.0), rises / 3.0);
    return 0.225 * middle + INNER_WEIGHT * inner + OUTER_WEIGHT * outer;
}

static bool is_far(const struct sight *s)
{
    double near = real_min(square(s[0].r), real_min(square(s[1].r), square(s[2].r)));
    bool far = true;
    for (int k = 0; k < 3 && far; k++)
        far = !(square(vec3_sub(s[(k + 1) % 3].r, s[k].r)) > FAR * FAR * near);
    return far;
}

/* Twice the area vector of a triangle, towards its back. */
static struct vec3 back_of(struct vec3 a, struct vec3 b, struct vec3 c)
{
    return vec3_cross(vec3_sub(c, a), vec3_sub(b, a));
}

/* F of a far triangle above the horizon, whose area vector is half of `back`. */
static double factor_by_points(const struct sight *s, struct vec3 back)
{
    return real_max(vec3_dot(s[0].r, back), 0.0) * mean_density(s) / (2.0 * PI);
}

/* F of a convex polygon above the horizon. */
static double factor_by_edges(const struct sight *s, struct vec3 normal, int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        struct vec3 from = s[k].r, to = s[k + 1 < count ? k + 1 : 0].r;
        struct vec3 cross = vec3_cross(to, vec3_sub(from, to));
        double length = vec3_length(cross);
        if (length > 0.0)
            sum += arctangent(length, vec3_dot(from, to)) *
                   (vec3_dot(normal, cross) / length);
    }
    return sum / (2.0 * PI);
}

/* Keeps the part of the triangle above the horizon in s[0..2]; returns the number of
 * corners. */
static int cut_at_horizon(struct sight s[4])
{
    struct sight old[3] = {s[0], s[1], s[2]};
    int count = 0;
    for (int k = 0; k < 3; k++) {
        struct sight from = old[k], to = old[(k + 1) % 3];
        if (from.rise >= 0.0)
            s[count++] = from;
        if ((from.rise > 0.0 && to.rise < 0.0) || (from.rise < 0.0 && to.rise > 0.0)) {
            double share = from.rise / (from.rise - to.rise);
            struct vec3 along = vec3_scale(vec3_sub(to.r, from.r), share);
            s[count++] = (struct sight){vec3_add(from.r, along), 0.0};
        }
    }
    return count;
}

/* F of a triangle of which a part is below the horizon. */
static double factor_of_rest(struct sight s[4], struct vec3 normal)
{
    int count = cut_at_horizon(s);
    const struct sight second[3] = {s[0], s[2], s[3]};
    if (!is_far(s) || (count == 4 && !is_far(second)))
        return factor_by_edges(s, normal, count);
    double factor = factor_by_points(s, back_of(s[0].r, s[1].r, s[2].r));
    if (count == 4)
        factor += factor_by_points(second, back_of(s[0].r, s[2].r, s[3].r));
    return factor;
}

static struct vec3 sizes(struct vec3 a)
{
    return (struct vec3){fabs(a.x), fabs(a.y), fabs(a.z)};
}

/* True if x lies in front of the triangle by more than the rounding of its coordinates:
 * the sum of the products is larger than 64 units in the last place of their sizes. */
static bool is_in_front(struct vec3 x, const struct triangle *t, struct vec3 r0,
                        struct vec3 back)
{
    struct vec3 u = sizes(vec3_sub(t->corner[2], t->corner[0]));
    struct vec3 v = sizes(vec3_sub(t->corner[1], t->corner[0]));
    struct vec3 products = {u.y * v.z + u.z * v.y, u.z * v.x + u.x * v.z,
                            u.x * v.y + u.y * v.x};
    struct vec3 place = vec3_add(sizes(x), sizes(t->corner[0]));
    return vec3_dot(r0, back) > GEOM_ROUNDING * vec3_dot(products, place);
}

double point_triangle_factor(struct vec3 x, struct vec3 normal, const struct triangle *t)
{
    struct sight s[4] = {{{0.0, 0.0, 0.0}, 0.0}};
    for (int k = 0; k < 3; k++) {
        s[k].r = vec3_sub(t->corner[k], x);
        s[k].rise = vec3_dot(normal, s[k].r);
    }
    struct vec3 back = back_of(t->corner[0], t->corner[1], t->corner[2]);
    double lowest = real_min(s[0].rise, real_min(s[1].rise, s[2].rise));
    double highest = real_max(s[0].rise, real_max(s[1].rise, s[2].rise));
    if (highest <= 0.0 || !is_in_front(x, t, s[0].r, back))
        return 0.0;
    double factor = lowest < 0.0 ? factor_of_rest(s, normal)
                    : is_far(s)  ? factor_by_points(s, back)
                                 : factor_by_edges(s, normal, 3);
    return real_max(real_min(factor, 1.0), 0.0);
}

double point_polygon_factor(struct vec3 x, struct vec3 normal, const struct vec3 *corners,
                            int32_t count)
{
    double sum = 0.0;
    for (int32_t k = 1; k + 1 < count; k++) {
        struct triangle t = {{corners[0], corners[k], corners[k + 1]}};
        struct triangle back = {{corners[0], corners[k + 1], corners[k]}};
        sum += point_triangle_factor(x, normal, &t) -
               point_triangle_factor(x, normal, &back);
    }
    return real_max(real_min(sum, 1.0), 0.0);
}
