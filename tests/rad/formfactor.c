/* Tests of rad/formfactor.h: Eq. 2 by hand, its sum over 16 pairs of sub-areas, and
 * bounds among blockers. (Against exact factors: tests/rad/beyond/factors.c.) */
#include "rad/formfactor.h"

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

/* Of all pairs of sub-areas, with nothing between them. */
static double sum_of_disks(const struct facet *p, const struct facet *q)
{
    double sum = 0.0;
    for (int k = 0; k < 16; k++) {
        struct triangle a = triangle_child(&p->triangle, k / 4);
        struct triangle b = triangle_child(&q->triangle, k % 4);
        sum += disk_exchange(triangle_centroid(&a), p->plane.normal, 0.25 * p->area,
                             triangle_centroid(&b), q->plane.normal, 0.25 * q->area);
    }
    return fmin(sum, fmin(p->area, q->area));
}

static double exchange_of(const struct world *world, const struct facet *p,
                          const struct facet *q)
{
    struct octree_counts counts = {0};
    int32_t blocker = -1;
    double seen;
    return exchange_area(p, q, world->octree, &blocker, &seen, &counts);
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
        off += fabs(free - sum_of_disks(&p, &q)) > 1e-14 * free;
        off += area > free || (seen == 1.0 && area < free) || (seen == 0.0 && area > 0.0);
        octree_destroy(none);
        world_free(&world);
    }
    tap_ok(pairs > 100 && partly > 30 && off == 0,
           "%d pairs, %d of them partly blocked: rays that arrive bring their parts",
           pairs, partly);
    tap_ok(beyond == 0, "never more than the smaller area, nor more than 16 rays");
}

int main(void)
{
    test_disk();
    test_flat();
    test_pairs();
    return tap_done();
}
