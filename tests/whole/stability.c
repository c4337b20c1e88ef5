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
 *     dim spaces beside bright ones   58-panel.sh
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

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_emission_scale();
    test_linearity();
    test_order(false);
    test_order(true);
    comm_stop(&world_comm);
    return tap_done();
}
