/* The furnace: in a closed scene whose surfaces all emit E and reflect rho, B = E / (1 - rho)
 * everywhere, whatever stands in it. And its cousin in which rho differs from triangle to triangle
 * and E = 1 - rho: B = 1.
 *
 * With --closure the row sums of the leaves are 1 at every level of refinement, so both hold at
 * every epsilon, within what the solver leaves: --tolerance bounds the mean error, and a single
 * leaf may be off by more, so 1e-8 is asked for where 1e-6 is tested. In the plain furnace that is
 * closed by rows the first step of conjugate gradients is exact; the cousin gives it work. Iterations are counted over all passes of refinement.
 *
 * What the closure must not do is hide leaks: it leaves alone what sees a way out, and such a leaf
 * would be dark here. So this is a test of the visibility and the closure's rays as well. */
#include "tests/defaults.h"
#include "tests/tap.h"

static const double LIMIT = 1e-6;

enum { ITERATIONS_MAX = 60 };

enum shape { CUBE, CORRIDOR, BOXES };

static const char *const SHAPE_NAMES[] = {"cube", "corridor 1:100", "boxes and slivers"};

/* A flat triangle, `width` times as wide as long, with a twin of opposite winding. */
static void add_sliver(struct painted *painted, struct vec3 from, struct vec3 to, double width)
{
    struct vec3 side = vec3_add(to, point(0.0, 0.0, width * vec3_length(vec3_sub(to, from))));
    soup_add(&painted->soup, (struct triangle){{from, to, side}});
    soup_add(&painted->soup, (struct triangle){{from, side, to}});
}

static void add_shape(struct painted *painted, enum shape shape)
{
    struct vec3 high = shape == CORRIDOR ? point(100, 1, 1) : point(1, 1, 1);
    soup_add_box(&painted->soup, point(0, 0, 0), high, 1, true);
    if (shape != BOXES)
        return;
    struct random random = random_seed(20);
    for (int i = 0; i < 8; i++) { /* one in each octant, apart from each other */
        struct vec3 low = point(0.08 + 0.5 * (i & 1), 0.08 + 0.5 * (i >> 1 & 1),
                                0.08 + 0.5 * (i >> 2 & 1));
        low = vec3_add(low, point(0.1 * random_unit(&random), 0.1 * random_unit(&random),
                                  0.1 * random_unit(&random)));
        struct vec3 size = point(random_between(&random, 0.02, 0.22),
                                 random_between(&random, 0.02, 0.22),
                                 random_between(&random, 0.02, 0.22));
        soup_add_box(&painted->soup, low, vec3_add(low, size), 1, false);
    }
    for (int i = 0; i < 5; i++) /* between the boxes */
        add_sliver(painted, point(0.03 + 0.011 * i, 0.05 + 0.007 * i, 0.5),
                   point(0.93 + 0.003 * i, 0.96, 0.5 + 0.01 * i), pow(10.0, -2 - i));
}

/* Largest |B / exact - 1| over the leaves. */
static double worst_leaf(const struct solution *s, double exact)
{
    const struct forest *forest = s->solver->model.forest;
    double worst = 0.0;
    for (int64_t p = 0; p < forest->count; p++)
        if (patch_is_leaf(&forest->patches[p]) && forest_area(forest, (int32_t)p) > 0.0)
            for (int c = 0; c < BANDS; c++) {
                double off = fabs(forest->patches[p].radiosity.band[c] / exact - 1.0);
                worst = off <= worst ? worst : off; /* NaN counts */
            }
    return worst;
}

static int deepest_level(const struct solution *s)
{
    int level = 0;
    for (int64_t p = 0; p < s->solver->model.forest->count; p++)
        level = id_level(s->solver->model.forest->patches[p].id) > level
                    ? id_level(s->solver->model.forest->patches[p].id) : level;
    return level;
}

static void judge(struct solution *s, const char *what, double exact, const char *words)
{
    double worst = worst_leaf(s, exact);
    tap_ok(s->vote.converged && worst <= LIMIT && s->stats.iterations <= ITERATIONS_MAX,
           "%s, %s: off by at most %.1e (%lld links, level %d, %lld iterations)", what, words,
           worst, (long long)s->stats.links, deepest_level(s), (long long)s->stats.iterations);
    solution_free(s);
}

static void test_furnace(const struct comm *comm, enum shape shape, double rho, double epsilon,
                         const char *words)
{
    char all[128], what[128];
    struct painted painted = {0};
    add_shape(&painted, shape);
    paint(&painted, rho, 1.0);
    snprintf(all, sizeof all, "--epsilon %g --tolerance 1e-8 %s", epsilon, words);
    snprintf(what, sizeof what, "%s, rho %g", SHAPE_NAMES[shape], rho);
    struct solution s = solve_scene(comm, scene_of_painted(&painted), all);
    judge(&s, what, 1.0 / (1.0 - rho), all);
}

/* rho from 0 to 0.999 in turns, E = 1 - rho. */
static void test_mixed(const struct comm *comm, enum shape shape, double epsilon,
                       const char *words)
{
    static const double rho[] = {0.0, 0.3, 0.999, 0.6, 0.9};
    char all[128], what[128];
    struct painted painted = {0};
    add_shape(&painted, shape);
    paint(&painted, 0.0, 1.0);
    struct scene *scene = scene_of_painted(&painted), *mixed;
    mixed = scene_create(scene->input_count, 5);
    for (int m = 0; m < 5; m++)
        mixed->materials[m] = material_grey(rho[m], 1.0 - rho[m]);
    for (int32_t i = 0; i < scene->input_count; i++) {
        mixed->triangles[i] = scene->triangles[i];
        mixed->material_of[i] = i % 5;
    }
    scene_destroy(scene);
    snprintf(all, sizeof all, "--epsilon %g --tolerance 1e-8 %s", epsilon, words);
    snprintf(what, sizeof what, "%s, rho 0 to 0.999, E = 1 - rho", SHAPE_NAMES[shape]);
    struct solution s = solve_scene(comm, mixed, all);
    judge(&s, what, 1.0, all);
}

/* Epsilon over six decades, with a limit to the level, which some of them reach; then without, as
 * deep as takes a few seconds at most. */
int main(int argc, char **argv)
{
    static const double rho[] = {0.5, 0.9, 0.99, 0.999};
    static const char *const rows[] = {"--closure rows --max-level 3", "--closure rows --max-level 3",
                                       "--closure rows --max-level 2"};
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    for (int shape = CUBE; shape <= BOXES; shape++) {
        for (int k = 0; k < 4; k++)
            for (int e = 0; e <= 6; e++)
                test_furnace(&comm, (enum shape)shape, rho[k], pow(10.0, -e), rows[shape]);
        for (int e = 0; e <= 3; e++) {
            test_mixed(&comm, (enum shape)shape, pow(10.0, -e), "--closure rows");
        }
    }
    test_furnace(&comm, CUBE, 0.5, 1e-5, "--closure rows");
    test_furnace(&comm, CUBE, 0.999, 1e-3, "--closure rows");
    test_furnace(&comm, CORRIDOR, 0.9, 1e-4, "--closure rows");
    test_furnace(&comm, BOXES, 0.9, 1e-4, "--closure rows");
    comm_stop(&comm);
    return tap_done();
}
