/* Tests of geom/polygon.h.
 *
 * A cut is judged twice. By its topology, exactly: every edge of the polygon belongs to
 * one triangle, in the polygon's direction, and every other edge to two triangles, in
 * opposite directions. By its area: the triangles' signed areas add up to the polygon's,
 * and so do the magnitudes, which no cut does that leaves the polygon or covers a part
 * twice. */
#include "geom/polygon.h"

#include <math.h>

#include "geom/alloc.h"
#include "tests/tap.h"

/* The signed sums of 1,000 areas of size 1 or less are off by less than this. */
static const double AREA_ERROR = 1e-12;

static int32_t *cut(const struct vec3 *corners, int32_t count)
{
    int32_t *triangles = alloc_array(3 * ((size_t)count - 2) + 1, sizeof *triangles);
    triangles[3 * (count - 2)] = -7;
    polygon_triangulate(corners, count, triangles);
    return triangles;
}

/* Counts each directed edge and checks the sums; false also for numbers out of range. */
static bool topology_is_right(const int32_t *triangles, int32_t count)
{
    signed char *edges = alloc_array((size_t)count * (size_t)count, 1);
    bool right = triangles[3 * (count - 2)] == -7;
    for (int32_t t = 0; t < 3 * (count - 2) && right; t++) {
        int32_t from = triangles[t], to = triangles[t % 3 == 2 ? t - 2 : t + 1];
        right = from >= 0 && from < count && to >= 0 && to < count && from != to;
        if (right)
            right = ++edges[(int64_t)from * count + to] == 1;
    }
    for (int32_t i = 0; i < count && right; i++) {
        for (int32_t j = 0; j < i; j++) {
            int there = edges[(int64_t)j * count + i],
                back = edges[(int64_t)i * count + j];
            bool forward = i == j + 1, closing = j == 0 && i == count - 1;
            right = right && there - back == (closing ? -1 : forward ? 1 : 0);
        }
    }
    alloc_free(edges);
    return right;
}

static struct vec3 cross_of(const struct vec3 *corners, int32_t a, int32_t b, int32_t c)
{
    return vec3_cross(vec3_sub(corners[b], corners[a]), vec3_sub(corners[c], corners[a]));
}

/* The sum of the triangles' areas seen along the polygon's normal is the sum of their
 * magnitudes, and that is the polygon's area. */
static bool area_is_right(const struct vec3 *corners, int32_t count,
                          const int32_t *triangles)
{
    struct vec3 whole = {0.0, 0.0, 0.0};
    for (int32_t i = 1; i + 1 < count; i++)
        whole = vec3_add(whole, cross_of(corners, 0, i, i + 1));
    double area = vec3_length(whole), signed_sum = 0.0, sum = 0.0;
    for (int32_t t = 0; t < count - 2; t++) {
        const int32_t *triangle = &triangles[3 * t];
        double part = vec3_dot(cross_of(corners, triangle[0], triangle[1], triangle[2]),
                               vec3_scale(whole, 1.0 / area));
        signed_sum += part;
        sum += fabs(part);
    }
    return fabs(sum - area) <= AREA_ERROR * area &&
           fabs(signed_sum - area) <= AREA_ERROR * area;
}

/* Checks topology and, where `has_area`, area. */
static void check(const char *name, const struct vec3 *corners, int32_t count,
                  bool has_area)
{
    int32_t *triangles = cut(corners, count);
    tap_ok(topology_is_right(triangles, count), "%s: each edge has its triangles", name);
    if (has_area)
        tap_ok(area_is_right(corners, count, triangles), "%s: the area is covered once",
               name);
    alloc_free(triangles);
}

static void check_fan(const char *name, const struct vec3 *corners, int32_t count)
{
    int32_t *triangles = cut(corners, count);
    bool fan = true;
    for (int32_t t = 0; t < count - 2; t++) {
        const int32_t *triangle = &triangles[3 * t];
        fan = fan && triangle[0] == 0 && triangle[1] == t + 1 && triangle[2] == t + 2;
    }
    tap_ok(fan, "%s: is the fan from corner 0", name);
    alloc_free(triangles);
}

/* The part of the area that the largest triangle has. */
static double largest_part(const struct vec3 *corners, int32_t count)
{
    int32_t *triangles = cut(corners, count);
    double largest = 0.0, sum = 0.0;
    for (int32_t t = 0; t < count - 2; t++) {
        const int32_t *triangle = &triangles[3 * t];
        double area =
            vec3_length(cross_of(corners, triangle[0], triangle[1], triangle[2]));
        largest = fmax(largest, area);
        sum += area;
    }
    alloc_free(triangles);
    return largest / sum;
}

static void test_convex(void)
{
    static const struct vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const struct vec3 skew[] = {{0, 0, 0}, {1, 0, 0.01}, {1, 1, 0}, {0, 1, 0.01}};
    check_fan("triangle", square, 3);
    check_fan("square", square, 4);
    check_fan("quadrilateral that is not plane", skew, 4);
    struct vec3 *circle = alloc_array(1000, sizeof *circle);
    for (int32_t i = 0; i < 1000; i++)
        circle[i] = (struct vec3){cos(i * 0.006283), 5.0, sin(i * 0.006283)};
    check("1,000 corners on a circle", circle, 1000, true);
    tap_ok(largest_part(circle, 1000) > 0.25,
           "1,000 corners on a circle: not into slivers alone");
    alloc_free(circle);
}

/* An L in all six orientations: three axes, seen from the front and from behind. */
static void test_orientations(void)
{
    static const double plane[6][2] = {{2, 2}, {0, 2}, {0, 0}, {1, 0}, {1, 1}, {2, 1}};
    for (int axis = 0; axis < 3; axis++) {
        for (int behind = 0; behind < 2; behind++) {
            struct vec3 corners[6];
            for (int i = 0; i < 6; i++) {
                double u = plane[behind ? 5 - i : i][0], v = plane[behind ? 5 - i : i][1];
                double w = 3.0 + 0.125 * u - 0.25 * v;
                corners[i] = axis == 0   ? (struct vec3){w, u, v}
                             : axis == 1 ? (struct vec3){v, w, u}
                                         : (struct vec3){u, v, w};
            }
            char name[32];
            snprintf(name, sizeof name, "L along axis %d, %s", axis,
                     behind ? "behind" : "front");
            check(name, corners, 6, true);
        }
    }
}

static void test_concave(void)
{
    static const struct vec3 arrow[] = {{0, 2, 0}, {-1, -1, 0}, {0, 0, 0}, {1, -1, 0}};
    static const struct vec3 bent[] = {
        {-1, -1, 0.05}, {0, 0, 0}, {1, -1, 0.05}, {0, 2, 0}, {-0.5, 0.5, -0.03}};
    check("arrow", arrow, 4, true);
    int32_t *triangles = cut(bent, 5);
    bool upwards = true;
    for (int t = 0; t < 3; t++) {
        const int32_t *triangle = &triangles[3 * t];
        upwards =
            upwards && cross_of(bent, triangle[0], triangle[1], triangle[2]).z > 0.0;
    }
    tap_ok(upwards, "bent arrow: all triangles face the polygon's side");
    alloc_free(triangles);
}

/* The holes are cut in by seams, along which the polygon runs twice. */
static void test_holes(void)
{
    static const struct vec3 frame[] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                                        {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0},
                                        {3, 1, 0}, {1, 1, 0}};
    static const struct vec3 two[] = {{0, 0, 0}, {9, 0, 0}, {9, 4, 0}, {0, 4, 0},
                                      {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0},
                                      {3, 2, 0}, {5, 2, 0}, {5, 3, 0}, {7, 3, 0},
                                      {7, 1, 0}, {5, 1, 0}, {5, 2, 0}, {3, 2, 0},
                                      {3, 1, 0}, {1, 1, 0}};
    static const struct vec3 ahead[] = {{0, 5, 0}, {2, 4, 0}, {1, 4, 0}, {0, 2, 0},
                                        {2, 2, 0}, {5, 2, 0}, {3, 4, 0}, {3, 3, 0},
                                        {1, 3, 0}, {3, 4, 0}, {5, 2, 0}, {4, 5, 0}};
    static const struct vec3 behind[] = {{2, 7, 0}, {2, 6, 0}, {6, 5, 0}, {1, 9, 0},
                                         {0, 3, 0}, {0, 1, 0}, {1, 3, 0}, {8, 4, 0},
                                         {4, 4, 0}, {6, 5, 0}, {2, 6, 0}, {1, 7, 0}};
    check("hole whose seam is needed by the ear behind it", ahead, 12, true);
    check("hole whose seam is needed by the ear before it", behind, 12, true);
    check("square with a hole", frame, 10, true);
    check("rectangle with two holes", two, 18, true);
}

static void test_repeated_and_collinear(void)
{
    static const struct vec3 straight[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                           {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    static const struct vec3 spike[] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {5, 1, 0},
                                        {2, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    static const struct vec3 slit[] = {{4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                                       {3, 2, 0}, {1, 1, 0}, {3, 2, 0}, {0, 0, 0}};
    static const struct vec3 point[7] = {{3, 3, 3}, {3, 3, 3}, {3, 3, 3}, {3, 3, 3},
                                         {3, 3, 3}, {3, 3, 3}, {3, 3, 3}};
    static const struct vec3 line[] = {
        {0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}, {5, 5, 5}};
    check("square with corners on its sides", straight, 8, true);
    int32_t *triangles = cut(straight, 8);
    bool thick = true;
    for (int t = 0; t < 6; t++)
        thick = thick && cross_of(straight, triangles[3 * t], triangles[3 * t + 1],
                                  triangles[3 * t + 2]).z > 0.0;
    tap_ok(thick, "square with corners on its sides: no triangle is flat");
    alloc_free(triangles);
    check("square with a spike", spike, 7, true);
    check("square with a slit", slit, 8, true);
    check("one point", point, 7, false);
    check("corners on a line", line, 5, false);
}

static void test_crossing(void)
{
    static const struct vec3 bow[] = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    static const struct vec3 huge[] = {{1e308, 1e308, 0}, {-1e308, 1e308, 0}, {0, 0, 0},
                                       {-1e308, -1e308, 0}, {1e308, -1e308, 0}};
    check("bow tie", bow, 4, false);
    check("corners whose distance overflows", huge, 5, false);
    struct vec3 *star = alloc_array(999, sizeof *star);
    for (int32_t i = 0; i < 999; i++)
        star[i] = (struct vec3){cos(i * 3.11), sin(i * 3.11), 0.0};
    check("star of 999 corners", star, 999, false);
    alloc_free(star);
}

static void make_comb(struct vec3 *corners, int32_t count)
{
    int32_t teeth = count - 2;
    for (int32_t i = 0; i < teeth; i++)
        corners[i] = (struct vec3){1.0 - (double)i / teeth, i % 2 ? 0.1 : 1.0, 0.0};
    corners[teeth] = (struct vec3){0.0, 0.0, 0.0};
    corners[teeth + 1] = (struct vec3){1.0, 0.0, 0.0};
}

static void test_large(void)
{
    struct vec3 *corners = alloc_array(1000, sizeof *corners);
    make_comb(corners, 1000);
    check("comb of 1,000 corners", corners, 1000, true);
    for (int32_t i = 0; i < 1000; i++)
        corners[i] = vec3_scale(corners[i], 1e-200);
    int32_t *triangles = cut(corners, 1000);
    for (int32_t i = 0; i < 1000; i++)
        corners[i] = vec3_scale(corners[i], 1e200);
    tap_ok(area_is_right(corners, 1000, triangles), "comb: a size of 1e-200 is no harm");
    alloc_free(triangles);
    alloc_free(corners);
}

/* The lower and the upper border of a heap of columns: a simple polygon with many
 * straight and repeated corners. `turned` about a slanted axis, straight corners are so
 * within rounding. */
static void make_heap(struct vec3 *corners, int32_t columns, uint32_t *seed, bool turned)
{
    int32_t count = 4 * columns, start = (int32_t)(*seed >> 20) % count;
    double low = 0.0, high = 0.0;
    for (int32_t i = 0; i < 2 * columns; i++) {
        *seed = *seed * 1664525u + 1013904223u;
        low = i % 2 ? low : -(double)(*seed >> 30);
        high = i % 2 ? high : 1.0 + (double)(*seed >> 28 & 3u);
        double u = i / 2 + i % 2;
        corners[(start + i) % count] = (struct vec3){u, low, 0.0};
        corners[(start + count - 1 - i) % count] = (struct vec3){u, high, 0.0};
    }
    for (int32_t i = 0; i < count && turned; i++) {
        struct vec3 x = corners[i];
        double u = 0.8253356149096783 * x.x - 0.5646424733950354 * x.y;
        double v = 0.5646424733950354 * x.x + 0.8253356149096783 * x.y;
        corners[i] = (struct vec3){100.1 + u, 0.7 * v - 3.3, 0.3 * v + 0.1 * u};
    }
}

static void test_random(bool turned)
{
    enum { COLUMNS = 20, COUNT = 4 * COLUMNS, ROUNDS = 1000 };
    struct vec3 corners[COUNT];
    uint32_t seed = 1;
    bool right = true;
    for (int round = 0; round < ROUNDS; round++) {
        make_heap(corners, COLUMNS, &seed, turned);
        int32_t *triangles = cut(corners, COUNT);
        right = right && topology_is_right(triangles, COUNT) &&
                area_is_right(corners, COUNT, triangles);
        alloc_free(triangles);
    }
    tap_ok(right, "%d random polygons with straight and repeated corners%s", (int)ROUNDS,
           turned ? ", turned" : "");
}

int main(void)
{
    test_convex();
    test_orientations();
    test_concave();
    test_holes();
    test_repeated_and_collinear();
    test_crossing();
    test_large();
    test_random(false);
    test_random(true);
    return tap_done();
}
