/* Tests of geom/lambert.h: laws of all polygons. Those around a point cover 1, parts add
 * up, far ones are points, the horizon cuts. Exact values: tests/rad/beyond/factors.c. */
#include "geom/lambert.h"

#include "tests/scenes.h"
#include "tests/tap.h"

/* Some ten terms of order 1, each with an error of two units in the last place. */
static const double ROUNDING = 2e-15;

/* The rectangle o, o + u, o + u + v, o + v. */
static void make_rectangle(struct vec3 o, struct vec3 u, struct vec3 v,
                           struct vec3 corners[4])
{
    corners[0] = o;
    corners[1] = vec3_add(o, u);
    corners[2] = vec3_add(corners[1], v);
    corners[3] = vec3_add(o, v);
}

static double rectangle_factor(struct vec3 x, struct vec3 normal, struct vec3 o,
                               struct vec3 u, struct vec3 v)
{
    struct vec3 corners[4];
    make_rectangle(o, u, v, corners);
    return point_polygon_factor(x, normal, corners, 4);
}

/* --- laws of all triangles --- */

static struct triangle turned_towards(struct triangle t, struct vec3 x)
{
    struct vec3 cross = triangle_cross(&t);
    return vec3_dot(cross, vec3_sub(x, t.corner[0])) < 0.0 ? reversed(t) : t;
}

static struct vec3 random_direction(struct random *random)
{
    struct vec3 v = random_point(random, 1.0);
    return vec3_length(v) > 0.1 ? vec3_unit(v) : random_direction(random);
}

/* Seen from inside, the four faces of a tetrahedron cover everything. */
static void test_closure(void)
{
    struct random random = random_seed(1);
    double worst = 0.0;
    for (int i = 0; i < 100000; i++) {
        struct vec3 corners[4], x = {0, 0, 0};
        double rest = 1.0;
        for (int k = 0; k < 4; k++) {
            corners[k] = random_point(&random, 0.5);
            double share = k == 3 ? rest : rest * random_unit(&random);
            x = vec3_add(x, vec3_scale(corners[k], share));
            rest -= share;
        }
        struct vec3 normal = random_direction(&random);
        struct triangle base = {{corners[0], corners[1], corners[2]}};
        double height = vec3_dot(triangle_cross(&base), vec3_sub(corners[3], corners[0]));
        double sum = 0.0;
        for (int k = 0; k < 4; k++) {
            struct triangle t = base;
            if (k < 3)
                t.corner[k] = corners[3];
            t = turned_towards(t, corners[k]);
            sum += point_triangle_factor(x, normal, &t);
        }
        /* Flat ones leave x on a face, within rounding. */
        if (fabs(height) > 1e-3)
            worst = fmax(worst, fabs(sum - 1.0));
    }
    /* The 12 edges are seen twice each, at the same angle; far faces by points, right to
     * 1e-9. */
    tap_ok(worst < 1e-9,
           "the faces of 100,000 tetrahedra cover 1 from inside (off by %.1e)", worst);
}

/* The sum over the 4^level parts of a triangle, each by a function. */
static double sum_of_parts(struct vec3 x, struct vec3 normal, const struct triangle *t,
                           int level,
                           double (*factor)(struct vec3, struct vec3,
                                            const struct triangle *))
{
    if (level == 0)
        return factor(x, normal, t);
    double sum = 0.0;
    for (int k = 0; k < 4; k++) {
        struct triangle child = triangle_child(t, k);
        sum += sum_of_parts(x, normal, &child, level - 1, factor);
    }
    return sum;
}

/* The larger ones go by edges and their descendants by points; many are cut by the
 * horizon. */
static void test_additivity(void)
{
    struct random random = random_seed(2);
    double worst = 0.0;
    int lit = 0, unsure = 0, unequal = 0;
    for (int i = 0; i < 20000; i++) {
        struct vec3 x = random_point(&random, 0.5), normal = random_direction(&random);
        struct triangle t = turned_towards(random_triangle(&random, 0.5, 0.3), x);
        double whole = point_triangle_factor(x, normal, &t);
        double parts = sum_of_parts(x, normal, &t, 3, point_triangle_factor);
        lit += whole > 0.0;
        worst = fmax(worst, fabs(parts - whole) / (1e-9 * whole + 64e-15));
        unsure += whole > 0.0 && whole < 1e-6;
        for (int k = 0; k < 3; k++)
            t.corner[k] = vec3_scale(t.corner[k], 0x1p-40);
        unequal += sum_of_parts(vec3_scale(x, 0x1p-40), normal, &t, 3,
                                point_triangle_factor) != parts;
    }
    /* 64 parts of error 1e-9 F + 1e-15. */
    tap_ok(lit > 10000 && worst <= 1.0,
           "64 parts make the whole, %d times (%d faint, %.2f of the"
           " tolerance)",
           lit, unsure, worst);
    tap_ok(unequal == 0, "2^40 times smaller: the same bits");
}

/* As a point: a triangle of size s at distance d has a relative error of (s/d)^2. */
static double factor_of_point(struct vec3 x, struct vec3 normal, const struct triangle *t)
{
    struct vec3 r = vec3_sub(triangle_centroid(t), x);
    double r2 = vec3_dot(r, r);
    return 0.5 * vec3_dot(normal, r) * -vec3_dot(triangle_cross(t), r) / (PI * r2 * r2);
}

static void test_far(void)
{
    struct random random = random_seed(3);
    double worst = 0.0;
    for (int i = 0; i < 2000; i++) {
        double distance = pow(10.0, random_between(&random, 4.0, 8.0));
        struct vec3 towards = random_direction(&random);
        struct vec3 normal = vec3_unit(vec3_add(towards, random_point(&random, 0.5)));
        struct triangle t = {{random_point(&random, 1), random_point(&random, 1),
                              random_point(&random, 1)}};
        struct vec3 x = vec3_scale(towards, -distance);
        t = turned_towards(t, x);
        struct vec3 cross = triangle_cross(&t);
        if (-vec3_dot(vec3_unit(cross), towards) < 0.01 || vec3_length(cross) < 0.01)
            continue;
        double right = sum_of_parts(x, normal, &t, 4, factor_of_point);
        worst = fmax(worst, fabs(point_triangle_factor(x, normal, &t) / right - 1.0));
    }
    /* (2 / 1e4)^2 / 256 = 1.6e-10 from the points; rounding of x at 1e8, 1.5e-8 of t's
     * size 1, turns the line of sight by 1.5e-16. */
    tap_ok(worst < 1e-9, "triangles 1e4 to 1e8 sizes away: off by %.1e, relative", worst);
}

/* --- horizon and plane --- */

static void test_horizon(void)
{
    struct vec3 o = {0, 0, 0}, up = {0, 0, 1};
    double worst = 0.0;
    for (int i = 0; i < 100; i++) {
        double below = 0.01 * pow(1.1, i), d = 0.3 + 0.01 * i;
        double whole = rectangle_factor(o, up, point(0, d, -below), point(2, 0, 0),
                                        point(0, 0, 1.0 + below));
        double above =
            rectangle_factor(o, up, point(0, d, 0), point(2, 0, 0), point(0, 0, 1));
        worst = fmax(worst, fabs(whole - above));
    }
    tap_ok(worst <= ROUNDING, "a polygon below the horizon does not count (off by %.1e)",
           worst);
    tap_ok(rectangle_factor(o, up, point(0, 1, -2), point(2, 0, 0), point(0, 0, 2)) ==
               0.0,
           "a wall below the horizon: 0");
    struct triangle touching = {{{0, 1, 0}, {-1, 1, -1}, {1, 1, -1}}};
    tap_ok(point_triangle_factor(o, up, &touching) == 0.0,
           "a triangle with its tip on it: 0");
    /* A wall so wide and high that it takes half of the hemisphere but for 1e-8. */
    double half =
        rectangle_factor(o, up, point(-5e7, 1, -5e7), point(1e8, 0, 0), point(0, 0, 1e8));
    tap_ok(fabs(half - 0.5) < 3e-8, "half of the hemisphere: %.9f", half);
}

static void test_plane(void)
{
    struct triangle t = {{{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}};
    struct vec3 up = {0, 0, 1};
    tap_ok(point_triangle_factor(point(0.2, 0.2, 1), up, &t) == 0.0,
           "on the plane, inside: 0");
    tap_ok(point_triangle_factor(point(3, 2, 1), point(-1, 0, 0), &t) == 0.0,
           "outside: 0");
    tap_ok(point_triangle_factor(t.corner[1], point(0, -1, 0), &t) == 0.0,
           "on a corner: 0");
    tap_ok(point_triangle_factor(point(0.5, 0.5, 1), up, &t) == 0.0, "on an edge: 0");
    tap_ok(point_triangle_factor(point(0.2, 0.2, 2), point(0, 0, -1), &t) == 0.0,
           "behind: 0");
    tap_ok(fabs(point_triangle_factor(point(0.2, 0.2, 1 - 1e-9), up, &t) - 1.0) < 1e-8,
           "just in front, inside: 1");
    tap_ok(point_triangle_factor(point(0.6, 0.6, 1 - 1e-9), up, &t) < 1e-8,
           "just in front, outside: 0");
    /* Right below an edge half of the hemisphere is covered; the corners at distance 1e9
     * h leave out 1e-9 of it. */
    tap_ok(fabs(point_triangle_factor(point(0.5, 0.5, 1 - 1e-9), up, &t) - 0.5) < 1e-8,
           "just in front of an edge: 1/2");
}

/* In a tilted plane rounding puts a point a little in front of the triangle or behind it;
 * in front of a twin that faces the other way all of its view would be covered. */
static void test_tilted_plane(void)
{
    struct random random = random_seed(6);
    int seen = 0;
    for (int i = 0; i < 20000; i++) {
        struct triangle t = random_triangle(&random, 0.5, 0.4), twin = reversed(t);
        if (triangle_is_degenerate(&t))
            continue;
        struct vec3 normal = triangle_plane(&t).normal, back = vec3_scale(normal, -1.0);
        struct triangle child = triangle_child(&t, i % 4);
        struct vec3 x = triangle_centroid(&child);
        seen += point_triangle_factor(x, normal, &t) > 0.0;
        seen += point_triangle_factor(x, normal, &twin) > 0.0;
        seen += point_triangle_factor(x, back, &t) > 0.0;
        seen += point_triangle_factor(x, random_direction(&random), &twin) > 0.0;
    }
    tap_ok(seen == 0, "on tilted planes: 0, within rounding (%d seen)", seen);
}

/* --- bounds --- */

/* Any triangles, also those with corners in one place or in line, seen from anywhere,
 * also from their corners and edges. */
static void test_bounds(void)
{
    struct random random = random_seed(5);
    int wrong = 0, lit = 0;
    for (int i = 0; i < 200000; i++) {
        struct triangle t = random_triangle(&random, 0.5, 0.4);
        double step = pow(10.0, random_between(&random, -18.0, 0.0));
        int kind = (int)(random_bits(&random) % 4);
        if (kind == 1)
            t.corner[2] = vec3_add(vec3_middle(t.corner[0], t.corner[1]),
                                   random_point(&random, step));
        if (kind == 2)
            t.corner[1] = vec3_add(t.corner[0], random_point(&random, step));
        struct vec3 x =
            random_bits(&random) & 1 ? random_point_on(&random, &t) : t.corner[2];
        x = vec3_add(x, random_point(&random, step));
        double f = point_triangle_factor(x, random_direction(&random), &t);
        wrong += !(f >= 0.0 && f <= 1.0);
        lit += f > 0.0;
    }
    tap_ok(wrong == 0 && lit > 50000,
           "200,000 triangles of all kinds, %d seen: 0 <= F <= 1", lit);
}

/* --- polygons --- */

static void test_polygons(void)
{
    struct vec3 up = {0, 0, 1}, x = {0.3, 0.4, 0};
    struct vec3 ell[6] = {{0, 0, 1}, {0, 2, 1}, {1, 2, 1},
                          {1, 1, 1}, {2, 1, 1}, {2, 0, 1}};
    double parts =
        rectangle_factor(x, up, point(0, 0, 1), point(0, 2, 0), point(1, 0, 0)) +
        rectangle_factor(x, up, point(1, 0, 1), point(0, 1, 0), point(1, 0, 0));
    double worst = 0.0;
    for (int first = 0; first < 6; first++) {
        struct vec3 corners[6];
        for (int k = 0; k < 6; k++)
            corners[k] = ell[(first + k) % 6];
        worst = fmax(worst, fabs(point_polygon_factor(x, up, corners, 6) - parts));
    }
    tap_ok(worst <= ROUNDING, "an L from each of its corners (off by %.1e)", worst);
    struct vec3 back[6];
    for (int k = 0; k < 6; k++)
        back[k] = ell[5 - k];
    tap_ok(point_polygon_factor(x, up, back, 6) == 0.0, "its back: 0");
    /* A regular polygon of 1000 corners and radius 1 at height 1: a disk, which covers
     * 1/2, less 1 - sin(a)/a of its area (a = 2 pi / 1000) at the rim, where the density
     * is 1/4 of that at the middle: 1/2 * 1/2 * 6.6e-6 in all. */
    enum { CORNERS = 1000 };
    static struct vec3 round[CORNERS];
    for (int k = 0; k < CORNERS; k++)
        round[k] = point(cos(-2.0 * PI * k / CORNERS), sin(-2.0 * PI * k / CORNERS), 1.0);
    double disk = point_polygon_factor(point(0, 0, 0), up, round, CORNERS);
    tap_ok(fabs(disk - 0.5 + 1.645e-6) < 1e-9, "a disk: %.9f", disk);
}

int main(void)
{
    test_closure();
    test_additivity();
    test_far();
    test_horizon();
    test_plane();
    test_tilted_plane();
    test_bounds();
    test_polygons();
    return tap_done();
}
