/* Tests of rad/beyond/gather/gather.h: rows and the light of leaves and points, against
 * closed forms. */
#include "rad/beyond/sequence.h"
#include "tests/gathered.h"
#include "tests/tap.h"

/* Everything shines as it absorbs, so B = H = 1 wherever one looks, behind objects and in
 * gaps; in single precision. */
static void test_furnished(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 2, true);
    paint(&soup, 0.7, 0.3);
    soup_add_box(&soup, point(0.2, 0.2, 0), point(0.5, 0.6, 0.4), 1, false);
    paint(&soup, 0.2, 0.8);
    soup_add_box(&soup, point(0.6, 0.2, 0.001), point(0.9, 0.6, 0.2), 1, false);
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--epsilon 1e-3", 64);
    double worst = 0.0;
    for (int64_t k = 0; k < g.s.solver->model.forest->count; k++)
        g.radiosity[k] = (struct rgb){{1.0, 1.0, 1.0}};
    for (int64_t i = 0; i < g.gather->count; i++)
        if (g.gather->rows[i].cover.bare == 1.0f &&
            g.gather->rows[i].cover.outside == 1.0f)
            worst = fmax(worst, fabs(irradiance(&g, i) - 1.0));
    tap_ok(worst <= 2e-6 && g.gather->counts.escaped == 0,
           "rows of %lld leaves sum to 1, within %.1e", (long long)g.gather->count,
           worst);
    tap_ok(g.gather->counts.rays > 64 * 60, "by %lld rays",
           (long long)g.gather->counts.rays);
    trial_free(&g);
}

/* A sheet between two others, all of it black: a ray meets one surface. More rays than a
 * sequence has points would tell no more, and errors would seem less. */
static void test_most_rays(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&soup, point(0.4, 0.4, 0.5), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    soup_add_quad(&soup, point(0.4, 0.4, 0.5), point(0.2, 0, 0), point(0, 0.2, 0), 1);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 2 * SEQUENCE_POINTS);
    int64_t rays = g.gather->counts.rays;
    int64_t leaves = g.gather->count - g.gather->counts.exact;
    tap_ok(leaves > 0 && rays == SEQUENCE_POINTS * leaves, "%lld rays for %lld leaves",
           (long long)rays, (long long)leaves);
    trial_free(&g);
}

/* Nothing stands between two plates: no rays, and the exact factor, .199825 for unit
 * squares at distance 1 (Howell C-11). Three points on each of eight
 * triangles: 0.05 %. */
static void test_open(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 2);
    paint(&soup, 0.5, 1.0);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 2);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "", 64);
    double h = mean_of_roots(&g, 8, 8), exact = 0.199824895698;
    tap_ok(g.gather->counts.rays == 0 && g.gather->counts.exact == g.gather->count,
           "open plates have exact rows only");
    tap_ok(fabs(h / exact - 1.0) <= 5e-4, "H %.6f, exact %.6f", h, exact);
    trial_free(&g);
}

/* A picture in the plane of a wall, of a quarter of its area. */
static void test_covered(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 8);
    soup_add_quad(&soup, point(0.25, 0.25, 0), point(0.5, 0, 0), point(0, 0.5, 0), 1);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 16);
    double bare = 0.0;
    for (int64_t i = 0; i < 128; i++)
        bare += (double)g.gather->rows[i].cover.bare / 128.0;
    tap_ok(fabs(bare - 0.75) < 1e-6, "of a wall with a picture in it %.3f is bare", bare);
    tap_ok(g.gather->rows[128].cover.bare == 1.0f, "as is all of the picture");
    trial_free(&g);
}

/* Four sides, seen from outside, stand on .04 of a floor below a ceiling. Where they
 * reach it nothing sees that part; where they do not it is the bottom of a bin. The few
 * rays that meet the ceiling inside of the column count as outside: 1 %, of .04. */
static void test_column(double height, double outside)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 4);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 4);
    struct vec3 at = {0.4, 0.4, 0.0}, side = {0.2, 0.0, 0.0}, up = {0.0, 0.0, height};
    for (int k = 0; k < 4; k++) {
        soup_add_quad(&soup, at, side, up, 1);
        at = vec3_add(at, side);
        side = vec3_cross(point(0, 0, 1), side);
    }
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 256);
    double share = 0.0;
    for (int64_t i = 0; i < 32; i++)
        share += (double)g.gather->rows[i].cover.outside / 32.0;
    tap_ok(fabs(share - outside) < 0.002,
           "a column of height %g stands on a floor: %.4f of it is outside", height,
           share);
    trial_free(&g);
}

/* A pillar with all of its faces stands in a corner of a room: rays from the two walls
 * there, from floor and ceiling begin inside, where they meet walls at its faces. */
static void test_pillar(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(0, 0, 0), point(0.4, 0.4, 1), 1, false);
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 256);
    double level = 0.0, upright = 0.0;
    for (int32_t i = 0; i < 12; i++) {
        struct vec3 normal = scene_root_plane(g.s.scene, i).normal;
        if (fabs(normal.z) > 0.5)
            level += (double)g.gather->rows[i].cover.outside / 4.0;
        else if (normal.x + normal.y > 0.5)
            upright += (double)g.gather->rows[i].cover.outside / 4.0;
    }
    tap_ok(fabs(level - 0.84) < 0.01 && fabs(upright - 0.6) < 0.01,
           "a pillar in a corner: %.3f of floor and ceiling are outside, %.3f of walls",
           level, upright);
    trial_free(&g);
}

/* A board hangs over a quarter of the floor of a room. Gaps below .031 are narrow for the
 * floor's two leaves. Near its rim rays leave the gap, of 1 % of the floor; edges where
 * walls meet are no gaps. */
static void test_board(double height, double open)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(0.25, 0.25, height), point(0.75, 0.75, 0.5), 1, false);
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 1024);
    double share = 0.0, others = 0.0;
    for (int64_t i = 0; i < 12; i++) {
        double up = scene_root_plane(g.s.scene, (int32_t)i).normal.z;
        *(up > 0.5 ? &share : &others) +=
            (double)g.gather->rows[i].cover.open / (up > 0.5 ? 2.0 : 10.0);
    }
    tap_ok(fabs(share - open) < 0.015 && fabs(others - 1.0) < 1e-9,
           "a board at the height %g leaves %.3f of a floor open, and of all else %g",
           height, share, others);
    trial_free(&g);
}

/* H at the middle of a ceiling, which a floor of 2 parts^2 leaves lights, without that
 * straight from lamps. */
static double light_of_floor(int parts)
{
    enum { SEEDS = 256 };
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), parts);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.4, 0.4, 0.045), point(0, 0.2, 0), point(0.2, 0, 0), 4);
    paint(&soup, 0.0, 100.0);
    soup_add_quad(&soup, point(0, 0, 0.05), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 16);
    const struct scene *scene = g.s.scene;
    int32_t last = scene_root_count(scene) - 1;
    struct triangle t = scene_root_triangle(scene, last);
    struct vec3 x = triangle_centroid(&t);
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = scene_root_plane(scene, last),
                                   .root = last};
    double light = 0.0;
    for (uint64_t seed = 0; seed < SEEDS; seed++)
        light += final_gather_at(g.gather, &points, seed, 1024, true).rest.band[0];
    trial_free(&g);
    return light / SEEDS;
}

/* A ceiling is lit by the floor, and that by a lamp of 32 facets which faces it, but not
 * the ceiling. Paths that go on from a floor of two leaves, which are too near for their
 * means, find the lamp: as much light as by the means of small leaves, but for rays which
 * end far enough away for the mean of half of the floor, found by links of few points. */
static void test_lamp_that_faces_away(void)
{
    double means = light_of_floor(8), points = light_of_floor(1);
    tap_ok(means > 0.1 && fabs(points / means - 1.0) <= 0.1,
           "by points of a floor a ceiling has H = %.3f, by means of leaves %.3f", points,
           means);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_furnished();
    test_most_rays();
    test_open();
    test_covered();
    test_column(1.0, 0.96);
    test_column(0.9, 1.0);
    test_pillar();
    test_board(0.01, 0.75);
    test_board(0.1, 1.0);
    test_lamp_that_faces_away();
    comm_stop(&world_comm);
    return tap_done();
}
