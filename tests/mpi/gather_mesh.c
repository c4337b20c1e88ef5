/* Tests of mpi/beyond/mesh.h: the leaves that a final gather splits, and the rays
 * that each of them gets. */
#include "mpi/beyond/beyond.h"
#include "mpi/beyond/mesh.h"
#include "mpi/beyond/stages.h"
#include "rad/beyond/gather/shots.h"
#include "tests/gathered.h"
#include "tests/tap.h"

/* A floor below a small lamp, and a small black box because of which rays are needed; the
 * links split nothing. Leaves are to be split until A times the variance of their light
 * over quarters is at most 0.005 epsilon of the sum of A B^2 (MESH in gather/mesh.c),
 * and no further. Chance moves the threshold by a factor of two at most. */
static void test_mesh(double epsilon)
{
    char words[32];
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 1.0 - 1e-3, 0.0);
    soup_add_quad(&soup, point(0.45, 0.45, 0.3), point(0, 0.1, 0), point(0.1, 0, 0), 1);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0.3, 0.3, 0.15), point(0.31, 0.31, 0.16), 1, false);
    paint(&soup, 0.0, 0.0);
    snprintf(words, sizeof words, "--epsilon %g", epsilon);
    struct solution s = solve_soup(&soup, words);
    const struct forest *forest = s.solver->model.forest;
    const struct gathered *gathered = &s.solver->beyond->answer->counts;
    double squares = 0.0, largest = 0.0, least = HUGE_VAL, goal = 0.005 * epsilon;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t p = 0; p < forest->count; p++) {
            const struct patch *patch = &forest->patches[p];
            struct triangle t = forest_triangle(forest, p);
            double area = forest_area(forest, p), h[4], mean = 0.0, spread = 0.0;
            if (patch->id.root > 1)
                continue;
            for (int k = 0; k < 4; k++) {
                struct triangle child = triangle_child(&t, k);
                h[k] = lit_by(forest->scene, 2, 4, &child);
                mean += 0.25 * h[k];
            }
            for (int k = 0; k < 4; k++)
                spread += 0.25 * (h[k] - mean) * (h[k] - mean);
            if (pass == 0 && patch_is_leaf(patch))
                squares += area * mean * mean;
            if (pass == 1 && patch_is_leaf(patch))
                largest = fmax(largest, area * spread / squares);
            else if (pass == 1)
                least = fmin(least, area * spread / squares);
        }
    tap_ok(largest <= 2.0 * goal, "varying over a leaf %.1e of all is left, %.1e allowed",
           largest, goal);
    tap_ok(least >= 0.5 * goal && least < 1.0,
           "leaves were split over which %.1e varied at least", least);
    double shots = (double)(gathered->rays + gathered->segments) / 2.0 /
                   (double)forest_count(forest).leaves;
    tap_ok(shots > 180.0 && shots <= 256.0,
           "as many rays and segments as %.0f of both for each leaf", shots);
    solution_free(&s);
}

/* A closed room with a table low above its floor, which nothing splits: rays of the table
 * find the dark of the floor below it, so all others have to see the floor brighter than
 * its mean. Otherwise light of the floor is lost, and irradiances have to be raised to
 * close the balance. */
static void test_near(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.8, 0.0);
    soup_add_box(&soup, point(0.3, 0.3, 0.03), point(0.7, 0.7, 0.05), 1, false);
    paint(&soup, 0.2, 0.0);
    soup_add_box(&soup, point(0.4, 0.4, 0.7), point(0.6, 0.6, 0.9), 1, false);
    paint(&soup, 0.0, 1.0);
    struct solution s = solve_soup(&soup, "--epsilon 0.1 --max-level 0");
    double closing = s.solver->beyond->answer->counts.closing;
    tap_ok(closing < 0.02, "irradiances are raised by %.1f %% to close a balance",
           100.0 * closing);
    solution_free(&s);
}

/* Where all is as bright as all else, nothing is split. */
static void test_even(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(0.6, 0.6, 0.1), point(0.8, 0.8, 0.5), 1, false);
    paint(&soup, 0.5, 1.0);
    struct solution s = solve_soup(&soup, "--epsilon 1e-2");
    tap_ok(s.solver->beyond->answer->counts.split == 0 &&
               s.solver->beyond->answer->counts.looks > 0,
           "in a furnace nothing is split, by %lld rays",
           (long long)s.solver->beyond->answer->counts.looks);
    solution_free(&s);
}

/* True if a look at a floor tells that a box stands on it which is so far above it. */
static bool is_cut_below(double height)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_box(&soup, point(0.30, 0.15, height), point(0.40, 0.25, 0.05), 1, false);
    paint(&soup, 0.0, 0.0);
    soup_add_quad(&soup, point(0, 0, 0.5), point(0, 1, 0), point(1, 0, 0), 2);
    paint(&soup, 0.0, 1.0);
    struct solution s = solve_soup(&soup, "--max-level 0 --final-gather 0");
    struct final_gather *gather =
        final_gather_create(&s.solver->model, 16, NULL, lit_find(&s.solver->model));
    bool cut = final_gather_look(gather, 0, 4).cut ||
               final_gather_look(gather, 1, 4).cut;
    final_gather_destroy(gather);
    solution_free(&s);
    return cut;
}

/* Where a thing stands on a leaf, few rays may not tell chance from light that differs
 * around it, and looks know it. */
static void test_cut(void)
{
    tap_ok(is_cut_below(0.0) && !is_cut_below(1e-3),
           "a box that stands on a floor cuts its leaves, one that hangs does not");
}

/* Every second cell of the walls of a room, upwards or downwards. */
static void add_cells(struct soup *soup, int odd)
{
    enum { CELLS = 10 };
    const double size = 2.0 / CELLS;
    for (int i = 0; i < CELLS; i++)
        for (int k = 0; k < CELLS; k++) {
            double a = i * size - 1.0, b = k * size - 1.0;
            if ((i + k) % 2 != odd)
                continue;
            soup_add_quad(soup, point(-1, a, b), point(0, size, 0), point(0, 0, size), 1);
            soup_add_quad(soup, point(1, a, b), point(0, 0, size), point(0, size, 0), 1);
            soup_add_quad(soup, point(b, -1, a), point(0, 0, size), point(size, 0, 0), 1);
            soup_add_quad(soup, point(b, 1, a), point(size, 0, 0), point(0, 0, size), 1);
            soup_add_quad(soup, point(a, b, -1), point(size, 0, 0), point(0, size, 0), 1);
            soup_add_quad(soup, point(a, b, 1), point(0, size, 0), point(size, 0, 0), 1);
        }
}

/* A small grey cube in the middle of a black room of which every second cell shines: its
 * light is as good as even, but whether a segment finds any is chance. Looks tell that:
 * the variance of a leaf's quarters is above its expectation for one leaf in four, which
 * may be split; otherwise all are, and again. Black leaves have four rays and segments
 * each; those of the cube have as many as all leaves in the mean, more of them segments,
 * since rays bring next to nothing, and as many aimed at the cube as rays, as all
 * reflected light is its. */
static void test_chance(void)
{
    enum { CUBE = 12, WALLS = 1200, MEAN = 256 };
    struct soup soup = {0};
    for (int odd = 0; odd < 2; odd++) {
        add_cells(&soup, odd);
        paint(&soup, 0.0, odd ? 1.0 : 0.0);
    }
    soup_add_box(&soup, point(-0.1, -0.1, -0.1), point(0.1, 0.1, 0.1), 1, false);
    paint(&soup, 0.5, 0.0);
    struct solution s = solve_soup(&soup, "--epsilon 0.1");
    const struct gathered *gathered = &s.solver->beyond->answer->counts;
    int64_t cube = s.stats.leaves - WALLS;
    tap_ok(4 * gathered->split <= CUBE && cube == CUBE + 3 * gathered->split,
           "of 12 leaves whose light varies by chance alone %lld are split",
           (long long)gathered->split);
    int64_t black = 4 * WALLS, all = 2 * (cube * MEAN + black);
    tap_ok(gathered->rays >= black && gathered->segments > black + cube * MEAN / 4 &&
               gathered->rays + gathered->segments <= all + gathered->rays,
           "%lld rays, %lld segments for %lld noisy leaves and 1200 black ones",
           (long long)gathered->rays, (long long)gathered->segments, (long long)cube);
    solution_free(&s);
}

/* A small bright cube in a room of which every second cell reflects: the light of the
 * quarters of its faces differs by chance alone, by as much as looks say, and by less
 * than half of the chance of each quarter, for rays from all of them have the same
 * directions. */
static void test_looks(void)
{
    enum { WALLS = 1200, RAYS = 16 };
    struct soup soup = {0};
    for (int odd = 0; odd < 2; odd++) {
        add_cells(&soup, odd);
        paint(&soup, odd ? 0.9 : 0.0, 0.0);
    }
    soup_add_box(&soup, point(-0.02, -0.02, -0.02), point(0.02, 0.02, 0.02), 1, false);
    paint(&soup, 0.5, 1.0);
    struct solution s = solve_soup(&soup, "--epsilon 0.1");
    struct model *model = &s.solver->model;
    struct final_gather *gather =
        final_gather_create(model, RAYS, NULL, lit_find(model));
    double spread = 0.0, noise = 0.0, alone = 0.0;
    int32_t p = forest_next_leaf(model->forest, -1);
    for (; p >= 0; p = forest_next_leaf(model->forest, p)) {
        if (model->forest->patches[p].id.root < WALLS)
            continue;
        struct gather_look look = final_gather_look(gather, p, RAYS);
        double sum = 0.0, squares = 0.0;
        for (int k = 0; k < 4; k++) {
            double b = (double)look.reflected[k][0];
            sum += b;
            squares += b * b;
        }
        spread += 0.25 * BANDS * (squares - 0.25 * sum * sum);
        noise += look.noise;
        alone += look.variance / RAYS;
    }
    tap_ok(spread < 2.0 * noise && spread > 0.5 * noise && noise < 0.5 * alone,
           "quarters differ by %.1e, %.1e expected, %.1e by rays of their own", spread,
           noise, alone);
    final_gather_destroy(gather);
    solution_free(&s);
}

/* The part of the leaves with reflected light whose error is more than this part of it,
 * if errors are normal. All is grey, and next to nothing is left of the equation: `error`
 * is 2.5 deviations in any band. */
static double leaves_beyond(const struct solution *s, double part)
{
    const struct forest *forest = s->solver->model.forest;
    double beyond = 0.0, all = 0.0;
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        double light = forest->radiosity[leaf].band[0] -
                       forest_material(forest, leaf)->emission.band[0];
        double error = (double)s->solver->beyond->answer->error[leaf];
        if (!(light > 0.0))
            continue;
        all += 1.0;
        beyond += error > 0.0 ? erfc(2.5 * part * light / (sqrt(2.0) * error)) : 0.0;
    }
    return beyond / all;
}

/* A box on a floor below a lamp. Half of the leaves exceed one of the errors told, a
 * tenth exceeds the other, by leaf and not by area. */
static void test_own_errors(const char *words)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(-2, -2, 0), point(4, 0, 0), point(0, 4, 0), 1);
    soup_add_box(&soup, point(-0.4, -0.3, 0), point(0.4, 0.3, 0.8), 1, false);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(-0.5, -0.5, 2), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 1.0);
    struct solution s = solve_soup(&soup, words);
    const struct gathered *told = &s.solver->beyond->answer->counts;
    double half = leaves_beyond(&s, told->median);
    double tenth = leaves_beyond(&s, told->worst_tenth);
    tap_ok(fabs(half - 0.5) < 0.005 && fabs(tenth - 0.1) < 0.005,
           "%.3f of the leaves are off by more than %.1f %%, %.3f by more than %.1f %%",
           half, 100.0 * told->median, tenth, 100.0 * told->worst_tenth);
    solution_free(&s);
}

/* With few rays, or where no leaf would be split whatever it shows, there are no looks.
 * Of three squares of a size, grey, white, and white below a lamp, the first reflects a
 * quarter of the noise that the second does, and the third is brighter than the mean.
 * (One of two boxes hides the other: rows by rays.) */
static void test_guess(const char *words)
{
    char all[80];
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.2, 0.0);
    soup_add_quad(&soup, point(0, 3, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&soup, point(0, 6, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.8, 0.0);
    soup_add_quad(&soup, point(0, 6, 0.5), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0, 2.5, 1), point(1, 4.5, 2), 1, false);
    soup_add_box(&soup, point(0, 2.5, 3), point(1, 4.5, 4), 1, false);
    paint(&soup, 0.0, 0.0);
    snprintf(all, sizeof all, "--max-level 0 %s", words);
    struct solution s = solve_soup(&soup, all);
    struct gather_mesh mesh = {.count = 0};
    bool made = solver_make_mesh(s.solver, 0, &mesh);
    const int *rays = mesh.rays;
    tap_ok(made && mesh.traced == 0 && 2 * rays[0] <= rays[2] && 2 * rays[2] <= rays[4],
           "%s: %d rays for a grey leaf, %d for a white one, %d below a lamp", words,
           rays[0], rays[2], rays[4]);
    gather_mesh_free(&mesh);
    solution_free(&s);
}

/* Shots are shared by worth: their sum is that of equal numbers at most and near it, and
 * the noise is less than of these. */
static void test_shots(void)
{
    enum { COUNT = 1000, MEAN = 256 };
    double worth[COUNT], shared = 0.0, equal = 0.0;
    int32_t group[COUNT] = {0};
    int shots[COUNT], sum = 0, wrong = 0;
    for (int k = 0; k < COUNT; k++)
        worth[k] = k < 10 ? 0.0 : exp(0.002 * k);
    shots_share(worth, group, COUNT, 1, MEAN, shots);
    for (int k = 0; k < COUNT; k++) {
        sum += shots[k];
        shared += worth[k] * worth[k] / shots[k];
        equal += worth[k] * worth[k] / MEAN;
        wrong += k < 10 ? shots[k] != MEAN / 4 : k > 0 && shots[k] < shots[k - 1];
    }
    tap_ok(wrong == 0 && sum <= MEAN * COUNT && sum > 0.9 * MEAN * COUNT &&
               shared < 0.9 * equal,
           "shots shared by worth: %.3f of all, noise %.2f of that of equal shares",
           (double)sum / (MEAN * COUNT), shared / equal);
    for (int k = 0; k < COUNT; k++)
        worth[k] = 0.0;
    shots_share(worth, group, COUNT, 1, MEAN, shots);
    tap_ok(shots[0] == MEAN && shots[COUNT - 1] == MEAN, "of no worth: all the mean");
}

static void do_nothing(void *context, int64_t item)
{
    (void)context;
    (void)item;
}

static double first_share;

static void keep_first(struct progress *progress)
{
    first_share = first_share > 0.0 ? first_share : progress->share;
}

/* The first of a thousand items, with half of all work, is half of the way. */
static void test_progress(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.5, 1.0);
    struct solution s = solve_soup(&soup, "--epsilon 1e-2 --final-gather 16");
    int64_t work[1000];
    struct progress progress = {.show = keep_first};
    struct stages stages = {.solver = s.solver,
                            .gather = s.solver->beyond->answer->gather,
                            .act = do_nothing, .work = work, .count = 1000};
    for (int i = 0; i < 1000; i++)
        work[i] = i == 500 ? 999 : 1;
    s.solver->progress = &progress;
    stages_run(&stages);
    tap_ok(first_share == 0.5 && progress.share == 1.0,
           "progress by work: %.3f after the heaviest of a thousand items", first_share);
    stages_free(&stages);
    s.solver->progress = NULL;
    solution_free(&s);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_mesh(0.1);
    test_mesh(0.02);
    test_near();
    test_even();
    test_cut();
    test_chance();
    test_looks();
    test_guess("--final-gather 16");
    test_guess("--final-gather 64 --epsilon 1e4");
    test_shots();
    test_progress();
    test_own_errors("--epsilon 1e-3 --final-gather 32 --tolerance 1e-9");
    test_own_errors("--max-level 0 --final-gather 32 --tolerance 1e-9");
    comm_stop(&world_comm);
    return tap_done();
}
