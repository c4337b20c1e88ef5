/* Mean factors.
 *
 * The mean is taken at three points with a rule exact for polynomials of the second
 * degree. Where the other triangle is nearer than the size of this one, the four quarters
 * of this one are taken, and theirs: then the points are an eighth of its size apart, too
 * far to find light getting out of a narrower gap. So across a gap the factor is the
 * exact one of both triangles. */
#include "rad/beyond/gather/factor.h"

#include "geom/contour.h"
#include "geom/lambert.h"
#include "rad/model.h"

enum { QUARTERINGS = 2 };

/* Tests taking about as long as the exact factor of two triangles. */
enum { TESTS_PER_EXACT_FACTOR = 400 };

static double factor_of_points(const struct triangle *from, struct vec3 normal,
                               const struct triangle *to, int64_t *work)
{
    struct vec3 x[3];
    double factor = 0.0;
    triangle_three_points(from, x);
    for (int k = 0; k < 3; k++)
        factor += point_triangle_factor(x[k], normal, to) / 3.0;
    *work += 3 * TESTS_PER_FORM_FACTOR;
    return factor;
}

/* From a point to the box around a triangle, squared. */
static double distance2_to_box(struct vec3 x, const struct triangle *t)
{
    struct vec3 below = vec3_sub(triangle_low(t), x);
    struct vec3 above = vec3_sub(x, triangle_high(t));
    struct vec3 none = {0.0, 0.0, 0.0};
    struct vec3 apart = vec3_most(none, vec3_most(below, above));
    return vec3_dot(apart, apart);
}

static bool is_near(const struct triangle *from, const struct triangle *to)
{
    double size = triangle_radius(from);
    return distance2_to_box(triangle_centroid(from), to) <= 4.0 * size * size;
}

/* True if the two face each other across a gap narrow beside the first: its width is less
 * than a fifth of the square root of the area. */
static bool is_across_gap(const struct triangle *from, struct vec3 normal,
                          const struct triangle *to)
{
    struct plane plane = triangle_plane(to);
    double width = plane_distance(&plane, triangle_centroid(from));
    return vec3_dot(normal, plane.normal) < -0.7 &&
           width * width < 0.04 * triangle_area(from);
}

static double factor_of_quarters(const struct triangle *from, struct vec3 normal,
                                 const struct triangle *to, int quarterings,
                                 int64_t *work)
{
    if (quarterings == 0 || !is_near(from, to))
        return factor_of_points(from, normal, to, work);
    double factor = 0.0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(from, k);
        factor += 0.25 * factor_of_quarters(&child, normal, to, quarterings - 1, work);
    }
    return factor;
}

double near_factor(const struct triangle *from, struct vec3 normal,
                   const struct triangle *to, int64_t *work)
{
    if (!is_near(from, to))
        return factor_of_points(from, normal, to, work);
    *work += TESTS_PER_EXACT_FACTOR;
    return triangle_exchange(from, to) / triangle_area(from);
}

double mean_factor(const struct triangle *from, struct vec3 normal,
                   const struct triangle *to, int64_t *work)
{
    if (!(triangle_radius(from) > 0.0)) { /* a point */
        *work += TESTS_PER_FORM_FACTOR;
        return point_triangle_factor(from->corner[0], normal, to);
    }
    if (is_near(from, to) && is_across_gap(from, normal, to))
        return near_factor(from, normal, to, work);
    return factor_of_quarters(from, normal, to, QUARTERINGS, work);
}
