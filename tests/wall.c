/* Tests of geom/wall.h: which triangles make up a wall, and what it hides. */
#include "geom/wall.h"

#include "tests/pairs.h"
#include "tests/tap.h"

/* --- making --- */

static struct walls *walls_of(const struct soup *soup)
{
    struct plane *planes = alloc_array((size_t)soup->count, sizeof *planes);
    for (int64_t i = 0; i < soup->count; i++)
        if (!triangle_is_degenerate(&soup->items[i]))
            planes[i] = triangle_plane(&soup->items[i]);
    struct walls *walls = walls_create(soup->items, planes, (int32_t)soup->count);
    alloc_free(planes);
    return walls;
}

/* Checks how many walls there are and how many corners they have together, frees the soup. */
static void expect(struct soup *soup, int32_t walls, int32_t corners, const char *name)
{
    struct walls *made = walls_of(soup);
    double all = 0.0, sum = 0.0;
    for (int64_t i = 0; i < soup->count; i++)
        all += triangle_area(&soup->items[i]);
    for (int32_t i = 0; i < made->count; i++)
        sum += made->items[i].area;
    tap_ok(made->count == walls && made->corner_count == corners && fabs(sum - all) < 1e-12,
           "%s: %d walls with %d corners", name, made->count, made->corner_count);
    walls_destroy(made);
    soup_free(soup);
}

/* n x n cells in the plane z = x / 4, but for the cells from `hole` on, side by side. */
static struct soup grid(int n, int hole, int holes)
{
    struct soup soup = {0};
    double step = 1.0 / 16; /* exact: cells share corners and lie in one plane to the bit */
    for (int i = 0; i < n * n; i++)
        if (i < hole || i >= hole + holes)
            soup_add_quad(&soup, point(step * (i % n), step * (i / n), 0.25 * step * (i % n)),
                          point(step, 0, 0.25 * step), point(0, step, 0), 1);
    return soup;
}

static void test_making(void)
{
    struct soup soup = grid(5, 0, 0);
    expect(&soup, 1, 4, "25 cells in one plane");
    soup = grid(5, 12, 1);
    expect(&soup, 48, 3 * 48, "with a hole");
    soup = grid(5, 24, 1);
    expect(&soup, 48, 3 * 48, "without a corner: not convex");
    soup = grid(5, 0, 5);
    expect(&soup, 1, 4, "without a whole row");
    soup = grid(5, 0, 0);
    for (int64_t i = 0; i < soup.count; i += 3) {
        struct triangle t = soup.items[i];
        soup.items[i] = (struct triangle){{t.corner[0], t.corner[2], t.corner[1]}};
    }
    expect(&soup, 1, 4, "some with their backs up");
    soup = (struct soup){0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 0.5, 0.25), 3, false);
    expect(&soup, 6, 24, "a box");
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&soup, point(0, -1, 0), point(0.5, 0, 0), point(0, 1, 0), 1);
    expect(&soup, 2, 8, "two squares whose edges do not match");
    soup_add_sphere(&soup, 0.4, 2);
    expect(&soup, 128, 3 * 128, "a sphere");
    soup_add(&soup, (struct triangle){{point(0, 0, 0), point(1, 0, 0), point(2, 0, 0)}});
    soup_add(&soup, tile(0, 0, 1, true));
    expect(&soup, 1, 3, "a degenerate triangle is no wall");
    soup_add(&soup, tile(0, 0, 1, true));
    soup_add(&soup, tile(0, 0, 1, true));
    struct walls *twice = walls_of(&soup);
    tap_ok(twice->count >= 1 && twice->of_triangle[0] >= 0 && twice->of_triangle[1] >= 0,
           "one triangle twice: %d walls", twice->count);
    walls_destroy(twice);
    soup_free(&soup);
}

/* --- hiding --- */

enum { TRIALS = 20000, SEGMENTS = 200 };

struct findings {
    int shadows, nines, less, wrong, boxes, boxes_wrong;
};

/* Nine segments between corners, each stopped by one of the two triangles. */
static bool nine_are_blocked(const struct triangle wall[2], const struct plane planes[2],
                             const struct triangle *p, const struct triangle *q)
{
    const int32_t none[2] = {-1, -1};
    for (int k = 0; k < 9; k++)
        if (brute_blocker(wall, planes, 2, p->corner[k / 3], q->corner[k % 3], none) < 0)
            return false;
    return true;
}

static void hold_against(struct random *random, const struct triangle wall[2],
                         const struct plane planes[2], const struct walls *walls,
                         const struct triangle *p, const struct triangle *q, struct findings *found)
{
    const int32_t none[2] = {-1, -1};
    struct shadow shadow;
    bool made = shadow_make(&shadow, walls, 0, p), hides = made && shadow_holds_triangle(&shadow, q);
    bool nine = nine_are_blocked(wall, planes, p, q);
    found->shadows += hides;
    found->nines += nine;
    found->less += nine && !hides;
    for (int k = 0; k < SEGMENTS && hides; k++)
        found->wrong += brute_blocker(wall, planes, 2, random_point_on(random, p),
                                      random_point_on(random, q), none) < 0;
    struct vec3 low = q->corner[0], high = vec3_add(low, point(0.2, 0.1, 0.05));
    bool holds = made && shadow_holds_box(&shadow, low, high);
    found->boxes += holds;
    for (int k = 0; k < SEGMENTS && holds; k++) {
        struct vec3 to = {random_between(random, low.x, high.x),
                          random_between(random, low.y, high.y),
                          random_between(random, low.z, high.z)};
        found->boxes_wrong += brute_blocker(wall, planes, 2, random_point_on(random, p), to, none) < 0;
    }
}

/* A tilted square in two triangles, and pairs of triangles around it. */
static void test_hiding(void)
{
    struct random random = random_seed(31);
    struct findings found = {0};
    for (int i = 0; i < TRIALS; i++) {
        struct soup soup = {0};
        struct vec3 u = {random_between(&random, 0.3, 0.6), 0, random_between(&random, -0.2, 0.2)};
        struct vec3 v = {0, random_between(&random, 0.3, 0.6), random_between(&random, -0.2, 0.2)};
        soup_add_quad(&soup, vec3_scale(vec3_add(u, v), -0.5), u, v, 1);
        struct plane planes[2] = {triangle_plane(&soup.items[0]), triangle_plane(&soup.items[1])};
        struct walls *walls = walls_of(&soup);
        struct triangle p = random_triangle(&random, 0.15, 0.1), q = random_triangle(&random, 0.15, 0.1);
        for (int k = 0; k < 3; k++) {
            p.corner[k].z += 0.1;
            q.corner[k].z -= 0.1;
        }
        if (walls->count == 1)
            hold_against(&random, soup.items, planes, walls, i % 2 ? &p : &q, i % 2 ? &q : &p, &found);
        walls_destroy(walls);
        soup_free(&soup);
    }
    tap_ok(found.shadows > TRIALS / 20 && found.wrong == 0,
           "%d of %d pairs are hidden; of %d segments each %d get through", found.shadows, TRIALS,
           SEGMENTS, found.wrong);
    tap_ok(found.nines > TRIALS / 20 && found.less == 0,
           "in all %d cases where nine segments are stopped a pair is hidden", found.nines);
    tap_ok(found.boxes > TRIALS / 100 && found.boxes_wrong == 0,
           "%d boxes are hidden; %d segments get through", found.boxes, found.boxes_wrong);
}

/* Inside a box no face sees what lies outside, through the face opposite or the one beside it. */
static void test_touching(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    struct walls *walls = walls_of(&soup);
    struct triangle floor = soup.items[0], outside = tile(0.2, 1.5, 0.1, false);
    int hidden = 0, own = 0, lid = 0;
    for (int32_t w = 0; w < walls->count; w++) {
        struct shadow shadow;
        bool made = shadow_make(&shadow, walls, w, &floor);
        bool holds = made && shadow_holds_triangle(&shadow, &outside);
        hidden += holds;
        own += made && w == walls->of_triangle[0];
        lid += holds && fabs(walls->items[w].plane.normal.z) > 0.5;
    }
    tap_ok(walls->count == 6 && own == 0, "no triangle lies in the shadow of its own wall");
    tap_ok(hidden == 1 && lid == 1, "through the lid only");
    struct triangle beside = {{point(5, 0.4, 0.5), point(5, 0.6, 0.5), point(5, 0.5, 0.6)}};
    int far = 0;
    for (int32_t w = 0; w < walls->count; w++) {
        struct shadow shadow;
        far += shadow_make(&shadow, walls, w, &soup.items[0]) &&
               shadow_holds_triangle(&shadow, &beside);
    }
    tap_ok(far == 1, "a face that shares an edge with the floor hides what is far behind it");
    walls_destroy(walls);
    soup_free(&soup);
}

int main(void)
{
    test_making();
    test_hiding();
    test_touching();
    return tap_done();
}
