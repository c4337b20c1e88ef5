/* A uniform sky around a scene: exact answers, whole runs with the default options. The
 * sky begins h / 1024 below the horizon of a point at height h, in half diagonals of the
 * scene: that is what upright faces are off by. */
#include <math.h>

#include "io/picture/mesh.h"
#include "io/scene/sky.h"
#include "tests/defaults.h"
#include "tests/tap.h"

static const double SKY = 3.0, RHO = 0.6;

/* Consumes the soup. */
static struct solution below_sky(const struct comm *comm, struct soup *soup)
{
    struct scene *scene = scene_of_soup(soup);
    sky_add(scene, (struct rgb){{SKY, SKY, SKY}});
    return solve(comm, prepared(scene),
                 criterion_parse("--epsilon 1e-4 --final-gather 4096"));
}

/* The largest deviation of H / SKY over the leaves of the roots first .. last. */
static double deviation(const struct solution *s, int32_t first, int32_t last,
                        double expected)
{
    const struct forest *forest = s->solver->model.forest;
    double largest = 0.0;
    for (int32_t p = 0; p < forest->count; p++) {
        int32_t root = (int32_t)forest->patches[p].id.root;
        if (patch_is_leaf(&forest->patches[p]) && root >= first && root <= last)
            largest = fmax(largest, fabs(forest->radiosity[p].band[0] / (RHO * SKY) -
                                         expected));
    }
    return largest;
}

/* Meshes have the leaves and vertices of the scene alone. */
static void test_mesh(const struct solution *s)
{
    const struct forest *forest = s->solver->model.forest;
    struct shading *shading = shading_create_flat(forest);
    int64_t leaves = 0, own = mesh_count(forest);
    for (int32_t leaf = mesh_next_leaf(forest, -1); leaf >= 0;
         leaf = mesh_next_leaf(forest, leaf))
        leaves += forest->patches[leaf].id.root < 2;
    tap_ok(own > 0 && leaves == own && shading->own_count == 3 * own &&
               shading->vertex_count > shading->own_count,
           "a mesh has %lld leaves, none of the sky", (long long)own);
    shading_destroy(shading);
}

/* A level plate that sees nothing but the sky. */
static void test_plate(const struct comm *comm)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(2, 0, 0), point(0, 1, 0), 1);
    paint(&soup, RHO, 0.0);
    struct solution s = below_sky(comm, &soup);
    double off = deviation(&s, 0, 1, 1.0), all = 3.0 * 2.0 * SKY;
    tap_ok(off < 1e-6, "a level plate: H = B within %.1e", off);
    tap_ok(fabs(s.stats.emitted_power / all - 1.0) < 1e-9 &&
               fabs(s.stats.absorbed_power / all - (1.0 - RHO)) < 1e-6 &&
               fabs(s.stats.escaped_power / all - RHO) < 1e-6,
           "%.6g W come, %.6g W are absorbed, %.6g W go back to the sky",
           s.stats.emitted_power, s.stats.absorbed_power, s.stats.escaped_power);
    test_mesh(&s);
    tap_ok(s.stats.triangles == 2, "of %lld triangles", (long long)s.stats.triangles);
    solution_free(&s);
}

/* A box on a black plain: its top sees the sky alone, its sides half of it. Facets near
 * the horizon share segments: noise of .3 % over the top. */
static void test_plain(const struct comm *comm)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(-1, -1, 0), point(1, 1, 2), 1, false);
    paint(&soup, RHO, 0.0);
    soup_add_quad(&soup, point(-200, -200, 0), point(400, 0, 0), point(0, 400, 0), 1);
    paint(&soup, 0.0, 0.0);
    struct solution s = below_sky(comm, &soup);
    double top = 1.0, side = 0.0;
    for (int32_t i = 0; i < 12; i++) {
        double up = s.scene->planes[i].normal.z;
        if (up > 0.5)
            top = fmin(top, 1.0 - deviation(&s, i, i, 1.0));
        else if (up > -0.5)
            side = fmax(side, deviation(&s, i, i, 0.5));
    }
    tap_ok(1.0 - top < 1e-3 && side < 5e-4,
           "a box on a black plain: top within %.1e, sides within %.1e", 1.0 - top, side);
    solution_free(&s);
}

/* A small plate in the middle of a strip of black ground, 2 wide, and black walls of
 * height 1 along one or both of its sides. */
static void check_strip(const struct comm *comm, const char *name, int walls,
                        double expected)
{
    static const double PARTS[5][4] = {{-0.01, -0.01, 0.02, 0.02}, {-1, -40, 0.99, 80},
                                       {0.01, -40, 0.99, 80}, {-0.01, -40, 0.02, 39.99},
                                       {-0.01, 0.01, 0.02, 39.99}};
    struct soup soup = {0};
    for (int k = 0; k < 5; k++) {
        const double *part = PARTS[k];
        soup_add_quad(&soup, point(part[0], part[1], 0), point(part[2], 0, 0),
                      point(0, part[3], 0), 1);
        paint(&soup, k == 0 ? RHO : 0.0, 0.0);
    }
    for (int side = 0; side < walls; side++) {
        double x = side ? 1.0 : -1.0;
        soup_add_quad(&soup, point(x, x * 40, 0), point(0, -x * 80, 0), point(0, 0, 1),
                      1);
    }
    paint(&soup, 0.0, 0.0);
    struct solution s = below_sky(comm, &soup);
    const struct forest *forest = s.solver->model.forest;
    double h = 0.5 * (forest->radiosity[0].band[0] + forest->radiosity[1].band[0]) /
               (RHO * SKY);
    tap_ok(fabs(h / expected - 1.0) < 2e-3, "%s: H / B %.5f, exact %.5f", name, h,
           expected);
    solution_free(&s);
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    test_plate(&comm);
    test_plain(&comm);
    check_strip(&comm, "a point before a long wall", 1, 0.5 * (1.0 + sqrt(0.5)));
    check_strip(&comm, "the bottom of a long slot", 2, sqrt(0.5));
    comm_stop(&comm);
    return tap_done();
}
