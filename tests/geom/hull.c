/* Tests of geom/hull.h: an empty hull is a proof, so no segment from front to front may
 * ever be blocked by a triangle that does not enter it; and one that does enter blocks
 * some. Of the octree's answers: tests/octree/octree.c. */
#include "geom/hull.h"

#include "tests/scenes.h"
#include "tests/tap.h"

enum { PAIRS = 20000, SEGMENTS = 40 };

/* Whether the triangle blocks one of some random segments from front to front. */
static bool blocks_some(struct random *random, const struct triangle *p,
                        const struct plane *plane_p, const struct triangle *q,
                        const struct plane *plane_q, const struct triangle *t)
{
    struct plane plane = triangle_plane(t);
    for (int i = 0; i < SEGMENTS; i++) {
        struct vec3 x = random_point_on(random, p), y = random_point_on(random, q);
        if (plane_distance(plane_p, y) <= 0.0 || plane_distance(plane_q, x) <= 0.0)
            continue;
        struct segment s = segment_make(x, y);
        if (segment_is_blocked_by(&s, t, &plane))
            return true;
    }
    return false;
}

static void test_proof(void)
{
    struct random random = random_seed(1);
    int entered = 0, blocked = 0, wrong = 0, tried = 0;
    for (int i = 0; i < PAIRS; i++) {
        struct triangle p = random_triangle(&random, 0.4, 0.1);
        struct triangle q = random_triangle(&random, 0.4, 0.1);
        struct triangle t = random_triangle(&random, 0.3, 0.2);
        if (triangle_is_degenerate(&p) || triangle_is_degenerate(&q) ||
            triangle_is_degenerate(&t))
            continue;
        struct plane plane_p = triangle_plane(&p), plane_q = triangle_plane(&q);
        struct hull hull = hull_of_pair(&p, &plane_p, &q, &plane_q);
        bool enters = hull_is_entered(&hull, &t);
        bool blocks = blocks_some(&random, &p, &plane_p, &q, &plane_q, &t);
        tried++;
        entered += enters;
        blocked += blocks;
        wrong += blocks && !enters;
    }
    tap_ok(tried > PAIRS / 2 && blocked > 100 && wrong == 0,
           "triangles outside the hull block nothing: %d triples, %d enter, %d block",
           tried, entered, blocked);
    /* A triangle may enter beside all 40 segments, but not often: if the hull were the
     * box around both, ten times as many would. */
    tap_ok(entered < 2 * blocked + 100, "most triangles that enter block a segment");
}

static const struct triangle FLOOR = {{{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}}};
static const struct triangle CEILING = {{{0, 0, 0.2}, {0, 0.2, 0.2}, {0.2, 0, 0.2}}};

static bool enters(struct triangle t)
{
    struct plane floor = triangle_plane(&FLOOR), ceiling = triangle_plane(&CEILING);
    struct hull hull = hull_of_pair(&FLOOR, &floor, &CEILING, &ceiling);
    return hull_is_entered(&hull, &t);
}

/* Between a floor and a ceiling, right above each other. */
static void test_places(void)
{
    tap_ok(enters((struct triangle){
               {{0.04, 0.04, 0.1}, {0.06, 0.04, 0.1}, {0.04, 0.06, 0.1}}}),
           "a speck in the middle enters");
    tap_ok(enters((struct triangle){{{-1, -1, 0.1}, {3, -1, 0.1}, {-1, 3, 0.1}}}),
           "so does a wall all across, with no corner inside");
    tap_ok(enters((struct triangle){
               {{0.15, 0.15, 0.1}, {0.09, 0.09, 0.1}, {0.15, 0.15, 0.12}}}),
           "and one that pokes in");
    tap_ok(!enters((struct triangle){
               {{0.15, 0.15, 0.1}, {0.11, 0.11, 0.1}, {0.15, 0.15, 0.12}}}),
           "one that ends before does not");
    tap_ok(!enters((struct triangle){{{0, 0, 0.1}, {0, 0.2, 0.1}, {0, 0.1, 0.15}}}) &&
               !enters((struct triangle){{{-0.1, 0, 0}, {0.3, 0, 0}, {0.1, 0, 0.2}}}),
           "nor one in a side");
    tap_ok(!enters((struct triangle){{{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}}}) &&
               !enters((struct triangle){{{-1, -1, -0.1}, {3, -1, -0.1}, {-1, 3, 0}}}),
           "nor one in the plane of a side, or behind");
    tap_ok(!enters((struct triangle){{{0.21, -1, 0.1}, {0.21, 1, 0}, {0.21, 1, 0.2}}}),
           "nor one that stands beside");
}

int main(void)
{
    test_proof();
    test_places();
    return tap_done();
}
