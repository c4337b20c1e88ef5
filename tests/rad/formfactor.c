/* Tests of rad/formfactor.h: Eq. 2 by hand, sums over subdivided squares that converge to
 * exact factors, and bounds among blockers. */
#include "rad/formfactor.h"

#include "geom/contour.h"
#include "tests/pairs.h"
#include "tests/tap.h"

static void test_disk(void)
{
    struct vec3 up = {0, 0, 1}, down = {0, 0, -1}, x = {0, 0, 0};
    double g = disk_exchange(x, up, 0.01, point(0, 0, 1), down, 0.04);
    tap_ok(fabs(g / (0.01 * 0.04 / (PI + 0.04)) - 1.0) < 1e-15,
           "A A' / (pi r^2 + the larger A)");
    /* both cosines 1 / sqrt(2), r^2 = 2 */
    g = disk_exchange(x, up, 0.01, point(0, 1, 1), down, 0.01);
    tap_ok(fabs(g / (0.5 * 0.0001 / (2.0 * PI + 0.01)) - 1.0) < 1e-15,
           "with both cosines");
    tap_ok(disk_exchange(x, up, 1, point(0, 0, -1), down, 1) == 0.0 &&
               disk_exchange(x, up, 1, point(0, 0, 1), up, 1) == 0.0,
           "nothing behind either plane");
}

static double exchange_of(const struct world *world, const struct facet *p,
                          const struct facet *q)
{
    struct octree_counts counts = {0};
    int32_t blocker = -1;
    double seen;
    return exchange_area(p, q, world->octree, &blocker, &seen, &counts);
}

/* --- sums over subdivided squares --- */

/* The facets of all patches of this level under roots first .. first + 1. */
static int64_t make_facets(const struct forest *forest, int32_t first, int level,
                           struct facet *facets)
{
    int64_t count = 0;
    for (int32_t root = first; root < first + 2; root++)
        for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
            if (id_level(forest->patches[p].id) == level)
                facets[count++] = facet_make(forest, p);
    return count;
}

static void split_all(struct forest *forest, int levels)
{
    for (int level = 0; level < levels; level++)
        for (int64_t p = 0, count = forest->count; p < count; p++)
            forest_split(forest, (int32_t)p);
}

/* The parallelogram origin, origin + u, origin + u + v, origin + v. */
struct square {
    struct vec3 origin, u, v;
};

static double exact_factor(const struct square *p, const struct square *q)
{
    struct vec3 corner[2][4];
    for (int k = 0; k < 2; k++) {
        const struct square *s = k ? q : p;
        corner[k][0] = s->origin;
        corner[k][1] = vec3_add(s->origin, s->u);
        corner[k][2] = vec3_add(corner[k][1], s->v);
        corner[k][3] = vec3_add(s->origin, s->v);
    }
    return polygon_exchange(corner[0], 4, corner[1], 4) / polygon_area(corner[0], 4);
}

/* Form factor from p to q, each in two triangles, with patches of these levels. */
static double form_factor(const struct square *p, const struct square *q, int level_p,
                          int level_q)
{
    struct soup soup = {0};
    soup_add_quad(&soup, p->origin, p->u, p->v, 1);
    soup_add_quad(&soup, q->origin, q->u, q->v, 1);
    struct world world = world_make(scene_of_soup(&soup));
    struct forest *forest = world.model.forest;
    split_all(forest, level_p > level_q ? level_p : level_q);
    struct facet *from = alloc_array((size_t)2 << (2 * level_p), sizeof *from);
    struct facet *to = alloc_array((size_t)2 << (2 * level_q), sizeof *to);
    int64_t count_p = make_facets(forest, 0, level_p, from);
    int64_t count_q = make_facets(forest, 2, level_q, to);
    double sum = 0.0, area = 0.0;
    for (int64_t i = 0; i < count_p; i++) {
        area += from[i].area;
        for (int64_t j = 0; j < count_q; j++)
            sum += exchange_of(&world, &from[i], &to[j]);
    }
    alloc_free(from);
    alloc_free(to);
    world_free(&world);
    return sum / area;
}

/* A small area is a point, and the disk has a wrong shape and its area in the
 * denominator: both errors fall with the square of the size, so 4 times with each level.
 * At a common edge distance and size shrink alike: there the error of each pair stays,
 * and the share of such pairs falls, half with each level. Bounds are the measured errors
 * and a quarter more: the method's honest accuracy. */
static void test_squares(void)
{
    static const struct {
        const char *name;
        struct square p, q;
        double bound[4]; /* of levels 0 to 3 */
        double ratio;    /* by which the error falls in the last level */
    } CASES[] = {{"parallel squares at 0.5",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}},
                  {1.2e-2, 5.7e-3, 1.7e-3, 4.4e-4},
                  3.8},
                 {"perpendicular squares with a common edge",
                  {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                  {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                  {1.4e-3, 8.3e-3, 7.3e-3, 4.7e-3},
                  1.5}};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        const struct square *p = &CASES[i].p, *q = &CASES[i].q;
        double error[4], exact = exact_factor(p, q);
        for (int level = 0; level < 4; level++) {
            error[level] = fabs(form_factor(p, q, level, level) / exact - 1.0);
            tap_ok(error[level] < CASES[i].bound[level],
                   "%s, level %d: off by %.1e, allowed %.1e", CASES[i].name, level,
                   error[level], CASES[i].bound[level]);
        }
        tap_ok(error[3] < error[2] / CASES[i].ratio,
               "%s: the error falls %g times in the last level", CASES[i].name,
               CASES[i].ratio);
    }
}

/* The case in which the paper's equation, taken literally, gives 24. */
static void test_small_below_large(void)
{
    const struct square small = {{0.45, 0.45, 0}, {0.1, 0, 0}, {0, 0.1, 0}},
                        large = {{0, 0, 0.1}, {0, 1, 0}, {1, 0, 0}};
    bool bounded = true;
    for (int level = 0; level < 5; level++)
        bounded = bounded && form_factor(&small, &large, 0, level) <= 1.0;
    tap_ok(bounded, "a small square below a large one: never above 1");
    /* Eight triangles for the small square, and above it patches of half its size or
     * less, leave an error of 5.1e-3. */
    double exact = exact_factor(&small, &large);
    double error = fabs(form_factor(&small, &large, 1, 5) / exact - 1.0);
    tap_ok(error < 6.5e-3, "and %.3f in the end (off by %.1e)", exact, error);
}

/* Two of the four sub-areas of a flat triangle lie side by side, closer than a disk of
 * their area is wide, and each of them alone fills the view of a speck. */
static void test_flat(void)
{
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{-0.5, 0, 0}, {0.5, 0, 0}, {0, 0.005, 0}}});
    soup_add(&soup, (struct triangle){{{0, 0, 0.005}, {0, 0.001, 0.005},
                                       {0.001, 0, 0.005}}});
    struct world world = world_make(scene_of_soup(&soup));
    struct facet p = facet_make(world.model.forest, 0);
    struct facet q = facet_make(world.model.forest, 1);
    double factor = exchange_of(&world, &p, &q) / q.area;
    tap_ok(factor > 0.9 && factor <= 1.0,
           "a speck above a flat triangle: F is at most 1 (%.4f)", factor);
    world_free(&world);
}

/* Random pairs among random blockers, and the same pairs alone. */
static void test_pairs(void)
{
    struct random random = random_seed(3);
    int pairs = 0, partly = 0, off = 0, beyond = 0;
    for (int i = 0; i < 400; i++) {
        struct soup soup = {0};
        soup_add_random(&soup, &random, 6, 0.4, 0.4);
        struct world world = world_make(scene_of_soup(&soup));
        struct octree *none = octree_create(NULL, NULL, 0);
        struct facet p = facet_make(world.model.forest, 0);
        struct facet q = facet_make(world.model.forest, 1);
        struct octree_counts counts = {0}, others = {0};
        int32_t blocker = -1, nothing = -1;
        double seen, all;
        double area = exchange_area(&p, &q, world.octree, &blocker, &seen, &counts);
        double free = exchange_area(&p, &q, none, &nothing, &all, &others);
        pairs += free > 0.0;
        partly += seen > 0.0 && seen < 1.0;
        beyond += free > fmin(p.area, q.area) || counts.rays > 16;
        off += area > free || (seen == 1.0 && area < free) || (seen == 0.0 && area > 0.0);
        octree_destroy(none);
        world_free(&world);
    }
    tap_ok(pairs > 100 && partly > 30 && off == 0,
           "%d pairs, %d of them partly blocked: only rays that arrive bring light",
           pairs, partly);
    tap_ok(beyond == 0, "never more than the smaller area, nor more than 16 rays");
}

int main(void)
{
    test_disk();
    test_squares();
    test_small_below_large();
    test_flat();
    test_pairs();
    return tap_done();
}
