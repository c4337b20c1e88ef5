/* Pitfalls of radiosity programs: one test for each entry of a checklist, but for those
 * that other tests cover:
 *
 *     F <= 1, G <= the smaller area      formfactor.c, patch_exchange.c, contour.c
 *     singular shared edges              contour.c, factors.c
 *     drift of row sums, slivers         58-panel.sh
 *     false convergence                  exact.c, conjugate.c
 *     rho >= 1, negative, NaN, huge Ke   75-materials.sh, obj.c, scene.c
 *     covered patches, interpenetration  58-panel.sh
 *     scale, faces without area, wide grounds   65-invariance.sh
 *     16 levels                          options.c refuses them; 15: 58-panel.sh
 *     leaks, faces twice, sheets on floors, tiny lamps, flipped faces   58-panel.sh
 *     oscillation, termination           a run of each test converges
 *     rays through edges and corners     octree.c, bundles.c
 *     T-vertices                         shading.c
 *     partial visibility                 lamps.c, 58-panel.sh
 *     open scenes                        exact.c, the links' own sum
 *     reciprocity                        node.c
 *
 * All with phr's defaults but for the options that a test names. */
#include "tests/defaults.h"
#include "tests/tap.h"
#include "mpi/beyond/beyond.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

static double radiosity(const struct solution *s, int64_t patch)
{
    return s->solver->model.forest->radiosity[patch].band[0];
}

/* True if b has the patches of a, and to the bit their light times `factor`. */
static bool is_multiple(const struct solution *a, const struct solution *b, double factor)
{
    const struct forest *one = a->solver->model.forest, *two = b->solver->model.forest;
    bool same = one->count == two->count;
    for (int64_t p = 0; same && p < one->count; p++)
        same = id_compare(one->patches[p].id, two->patches[p].id) == 0 &&
               radiosity(b, p) == factor * radiosity(a, p);
    return same;
}

static void add_room(struct soup *soup, int n)
{
    soup_add_box(soup, point(0, 0, 0), point(1, 1, 1), n, true);
}

/* A room of rho 0.5 with a box that floats in it and a square lamp below its ceiling. */
static struct soup furnished(double lamp, double box)
{
    struct soup soup = {0};
    add_room(&soup, 1);
    paint(&soup, 0.5, 0.0);
    soup_add_box(&soup, point(0.3, 0.2, 0.1), point(0.7, 0.5, 0.4), 1, false);
    paint(&soup, 0.3, box);
    soup_add_quad(&soup, point(0.4, 0.4, 0.95), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    paint(&soup, 0.0, lamp);
    return soup;
}

static struct solution solve_furnished(double lamp, double box, const char *words)
{
    struct soup soup = furnished(lamp, box);
    return solve_soup(&soup, words);
}

static void test_emission_scale(void)
{
    static const int powers[] = {-80, -1, 60};
    struct solution one = solve_furnished(1.0, 0.25, "--epsilon 1e-3");
    for (int k = 0; k < COUNT(powers); k++) {
        double factor = ldexp(1.0, powers[k]);
        struct solution two =
            solve_furnished(factor, 0.25 * factor, "--epsilon 1e-3");
        tap_ok(is_multiple(&one, &two, factor),
               "emission times 2^%d: so is the light, to the bit", powers[k]);
        solution_free(&two);
    }
    tap_ok(one.stats.patches > 1000, "on %lld patches", (long long)one.stats.patches);
    solution_free(&one);
}

/* E1, E2 and both on a fixed mesh. */
static void test_linearity(void)
{
    const char *words = "--epsilon 0 --max-level 0 --tolerance 1e-14 --final-gather 0";
    struct solution one = solve_furnished(1.0, 0.0, words);
    struct solution two = solve_furnished(0.0, 0.7, words);
    struct solution both = solve_furnished(1.0, 0.7, words);
    double worst = 0.0;
    for (int32_t i = 0; i < both.scene->input_count; i++)
        worst = fmax(worst, fabs((radiosity(&one, i) + radiosity(&two, i)) /
                                     radiosity(&both, i) -
                                 1.0));
    tap_ok(worst <= 1e-12 && radiosity(&one, 0) > 0.0 && radiosity(&two, 0) > 0.0,
           "light of two lamps is the sum of the light of each (within %.1e)", worst);
    solution_free(&one);
    solution_free(&two);
    solution_free(&both);
}

/* A tetrahedron of 64 triangles seen from inside, one side lit. All sees all, so that no
 * segment hits or misses an edge by a rounding; and no two sides have the same area, so
 * that it is clear which patch of a link is the smaller one, from which its form factor
 * is taken. Face i is number (i times + plus) % 64, its corners turned if `turn`. */
static struct scene *tetrahedron(int times, int plus, bool turn)
{
    const struct vec3 v[4] = {point(0, 0, 0), point(1, 0.1, 0), point(0.2, 0.8, 0.1),
                              point(0.3, 0.2, 0.7)};
    static const int sides[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    struct scene *scene = scene_create(64, 4);
    for (int i = 0; i < 64; i++) {
        const int *side = sides[i / 16];
        struct triangle t = {{v[side[0]], v[side[1]], v[side[2]]}};
        t = triangle_child(&t, i / 4 % 4);
        t = triangle_child(&t, i % 4);
        int to = (i * times + plus) % 64, k = turn ? i % 3 : 0;
        for (int c = 0; c < 3; c++)
            scene->triangles[to].corner[c] = t.corner[(k + c) % 3];
        scene->material_of[to] = i / 16;
        scene->materials[i / 16] = material_grey(0.4 + 0.1 * (i / 16), i < 16);
    }
    return scene;
}

/* Sums are integers, so only the corner at which a calculation begins matters: last bits
 * of form factors, kept as floats. It does not hold between patches of equal areas, nor
 * with blockers: which patch's points are taken, and which segments are tried, depends on
 * the numbers of the roots. */
static void test_order(bool turn)
{
    const char *words = "--epsilon 0 --max-level 0 --tolerance 1e-13";
    struct solution one = solve_scene(tetrahedron(1, 0, false), words);
    struct solution two = solve_scene(tetrahedron(11, 5, turn), words);
    double off = 0.0;
    for (int i = 0; i < 64; i++) {
        double b = radiosity(&two, (11 * i + 5) % 64);
        off = fmax(off, fabs(b / radiosity(&one, i) - 1.0));
    }
    tap_ok(off <= 1e-12, "faces in another order%s: the same light within %.1e",
           turn ? " and corners turned" : "", off);
    solution_free(&one);
    solution_free(&two);
}

/* --- spaces --- */

/* Area times radiosity over area, of the roots first .. first + count - 1. W/m^2, first
 * band. */
static double mean_radiosity(const struct solution *s, int32_t first, int32_t count)
{
    const struct forest *forest = s->solver->model.forest;
    double light = 0.0, area = 0.0;
    for (int32_t root = first; root < first + count; root++) {
        light += forest_area(forest, root) * radiosity(s, root);
        area += forest_area(forest, root);
    }
    return light / area;
}

/* A closed room of 32 triangles from (x, 0, 0) on, with a box on its floor, and a lamp
 * below its ceiling, unless this is 0. */
static void add_lit_room(struct soup *soup, double x, double size, double lamp)
{
    soup_add_box(soup, point(x, 0, 0), point(x + size, size, size), 1, true);
    paint(soup, 0.5, 0.0);
    soup_add_box(soup, point(x + 0.2 * size, 0.2 * size, 0),
                 point(x + 0.5 * size, 0.6 * size, 0.4 * size), 1, false);
    paint(soup, 0.3, 0.0);
    soup_add_box(soup, point(x + 0.4 * size, 0.4 * size, 0.9 * size),
                 point(x + 0.6 * size, 0.6 * size, 0.95 * size), 1, false);
    paint(soup, 0.2, lamp);
}

enum { ROOM_ROOTS = 36 };

/* Of a room whose first root is given: the number of leaves, the mean of what the walls
 * reflect, W/m^2, and the RMS over the walls of the bound on errors, W/m^2. */
struct room {
    double leaves, light, error;
};

static struct room room_at(const struct solution *s, int32_t first)
{
    const struct forest *forest = s->solver->model.forest;
    struct room room = {0.0, mean_radiosity(s, first, 12), 0.0};
    double area = 0.0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        int32_t root = (int32_t)forest->patches[leaf].id.root - first;
        double error = (double)s->solver->beyond->answer->error[leaf];
        room.leaves += root >= 0 && root < ROOM_ROOTS;
        if (root < 0 || root >= 12)
            continue;
        area += forest_area(forest, leaf);
        room.error += forest_area(forest, leaf) * error * error;
    }
    room.error = sqrt(room.error / area);
    return room;
}

static bool is_within(double a, double b, double part)
{
    return fabs(a - b) <= part * b;
}

/* Beside a bright room, behind a wall without thickness or far away, a dim one of any
 * size has the leaves, the light and the errors that it has alone. (Leaves and errors are
 * by chance: rooms differ in the order of faces.) One without a lamp is dark. What is
 * told of all is a fifth more at most: looks have spent segments on the other lamp. */
static void test_dim_room(double x, double size, double lamp, const char *words)
{
    struct soup soup = {0};
    add_lit_room(&soup, x, size, 1.0);
    struct solution alone = solve_soup(&soup, words);
    add_lit_room(&soup, 0.0, 1.0, 1.0);
    struct solution bright = solve_soup(&soup, words);
    add_lit_room(&soup, 0.0, 1.0, 1.0);
    add_lit_room(&soup, x, size, lamp);
    add_lit_room(&soup, -2.0, 2.0, 0.0);
    struct solution s = solve_soup(&soup, words);
    struct room dim = room_at(&s, ROOM_ROOTS), dim_alone = room_at(&alone, 0);
    struct room lit = room_at(&s, 0), lit_alone = room_at(&bright, 0);
    tap_ok(is_within(dim.leaves, dim_alone.leaves, 0.1) &&
               is_within(dim.light, lamp * dim_alone.light, 0.01) &&
               is_within(dim.error, lamp * dim_alone.error, 0.1),
           "a room of %.1f with a lamp of %.0e: %.0f leaves (%.0f alone), %.3f of the "
           "light, %.3f of the error",
           size, lamp, dim.leaves, dim_alone.leaves, dim.light / lamp / dim_alone.light,
           dim.error / lamp / dim_alone.error);
    tap_ok(is_within(lit.leaves, lit_alone.leaves, 0.05) &&
               is_within(lit.light, lit_alone.light, 0.001) &&
               is_within(lit.error, lit_alone.error, 0.05),
           "beside which is one of 1: %.0f leaves (%.0f alone), %.4f of the light, %.3f "
           "of the error",
           lit.leaves, lit_alone.leaves, lit.light / lit_alone.light,
           lit.error / lit_alone.error);
    double told = alone.solver->beyond->answer->counts.error;
    tap_ok(mean_radiosity(&s, 2 * ROOM_ROOTS, ROOM_ROOTS) == 0.0 &&
               is_within(s.solver->beyond->answer->counts.error, told, 0.2),
           "and a dark one; the error of all is %.2f %%, alone %.2f %%",
           100.0 * s.solver->beyond->answer->counts.error, 100.0 * told);
    solution_free(&alone);
    solution_free(&bright);
    solution_free(&s);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_emission_scale();
    test_linearity();
    test_order(false);
    test_order(true);
    test_dim_room(1.0, 1.0, 1e-3, "");
    test_dim_room(4.0, 0.3, 1e-6, "");
    test_dim_room(1.0, 3.0, 1e-9, "");
    comm_stop(&world_comm);
    return tap_done();
}
