/* Tests of rad/formfactor.h: Eq. 2 by hand, and its error by 16 rays. (With all else
 * about the disks in tests/rad/beyond/patch_exchange.c, which goes another way to the
 * same numbers.) */
#include "rad/formfactor.h"

#include "rad/beyond/patch_exchange.h"

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

/* Random pairs among random blockers: the same by the other kernel, as phr looks at
 * all. */
static void test_pairs(void)
{
    struct random random = random_seed(3);
    int pairs = 0, partly = 0, off = 0, beyond = 0;
    for (int i = 0; i < 400; i++) {
        struct soup soup = {0};
        soup_add_random(&soup, &random, 6, 0.4, 0.4);
        struct world world = world_make(scene_of_soup(&soup));
        struct facet p = facet_make(world.model.forest, 0);
        struct facet q = facet_make(world.model.forest, 1);
        struct octree_counts counts = {0}, others = {0};
        struct visibility visibility = {.blocker = -1};
        int32_t blocker = -1;
        double seen, area = exchange_area(&p, &q, world.octree, &blocker, &seen, &counts);
        struct exchange other = exchange_estimate(&p, &q, FORM_FACTOR_DISK,
                                                  world.octree, &visibility, &others);
        double limit = fmin(p.area, q.area);
        pairs += area > 0.0;
        partly += seen > 0.0 && seen < 1.0;
        beyond += area > limit || counts.rays > 16 || counts.rays != others.rays;
        /* Where disks overlap the other kernel is smaller without blockers. */
        off += other.unoccluded < limit && fabs(area - other.area) > 1e-14 * limit;
        world_free(&world);
    }
    tap_ok(pairs > 100 && partly > 30 && off == 0,
           "%d pairs, %d of them partly blocked: the sum over the rays that arrive",
           pairs, partly);
    tap_ok(beyond == 0, "never more than the smaller area, nor more than 16 rays");
}

int main(void)
{
    test_disk();
    test_pairs();
    return tap_done();
}
