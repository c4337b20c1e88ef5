/* Light in gaps: a whole run with phr's defaults of a room in which things hang and stand
 * 2 mm from each other. The truth is that of the path tracer. */
#include "mpi/beyond/beyond.h"
#include "tests/defaults.h"
#include "tests/tap.h"
#include "tests/truth.h"

/* --- a room with gaps of 2 mm; z is up --- */

static const double GAP = 0.002, SIDE = 4.0, HIGH = 2.5;

static void add_box(struct soup *soup, double x, double y, double z, double dx, double dy,
                    double dz)
{
    soup_add_box(soup, point(x, y, z), point(x + dx, y + dy, z + dz), 1, false);
}

/* All faces of a box but that below; `sign`: 1 outwards, -1 inwards. */
static void add_cap(struct soup *soup, struct vec3 low, struct vec3 high, int sign)
{
    struct vec3 top = point(low.x, low.y, high.z);
    soup_add_rectangle(soup, low, point(low.x, high.y, high.z), -sign);
    soup_add_rectangle(soup, point(high.x, low.y, low.z), high, sign);
    soup_add_rectangle(soup, low, point(high.x, low.y, high.z), -sign);
    soup_add_rectangle(soup, point(low.x, high.y, low.z), high, sign);
    soup_add_rectangle(soup, top, high, sign);
}

/* Places along x and y where the ceiling and its four recesses begin and end. */
static const double FIELDS[] = {0.0, 0.8, 1.4, 2.6, 3.2, 4.0};

static bool is_recess(int i, int k)
{
    return i % 2 == 1 && k % 2 == 1;
}

/* The shell, with recesses 5 cm deep. */
static void add_shell(struct soup *soup)
{
    soup_add_rectangle(soup, point(0, 0, 0), point(SIDE, SIDE, 0), 1);
    soup_add_rectangle(soup, point(0, 0, 0), point(0, SIDE, HIGH), 1);
    soup_add_rectangle(soup, point(SIDE, 0, 0), point(SIDE, SIDE, HIGH), -1);
    soup_add_rectangle(soup, point(0, 0, 0), point(SIDE, 0, HIGH), 1);
    soup_add_rectangle(soup, point(0, SIDE, 0), point(SIDE, SIDE, HIGH), -1);
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 5; k++) {
            struct vec3 low = point(FIELDS[i], FIELDS[k], HIGH);
            struct vec3 high = point(FIELDS[i + 1], FIELDS[k + 1], HIGH + 0.05);
            if (is_recess(i, k))
                add_cap(soup, low, high, -1);
            else
                soup_add_rectangle(soup, low, point(high.x, high.y, HIGH), -1);
        }
}

/* Lamps that fill the recesses but for a gap; they shine downwards. */
static void add_lamps(struct soup *soup)
{
    for (int part = 0; part < 2; part++) {
        for (int i = 0; i < 25; i++) {
            if (!is_recess(i % 5, i / 5))
                continue;
            const double *x = &FIELDS[i % 5], *y = &FIELDS[i / 5];
            struct vec3 low = point(x[0] + GAP, y[0] + GAP, HIGH + 0.01);
            struct vec3 high = point(x[1] - GAP, y[1] - GAP, HIGH + 0.05 - GAP);
            if (part == 0)
                soup_add_rectangle(soup, low, point(high.x, high.y, low.z), -1);
            else
                add_cap(soup, low, high, 1);
        }
        paint(soup, 0.5, part == 0 ? 20.0 : 0.0);
    }
}

/* Pictures and cupboards on the walls, a table with a sheet of paper, a rug. */
static void add_things(struct soup *soup)
{
    add_box(soup, 0.5, GAP, 1.3, 0.8, 0.02, 0.6);
    add_box(soup, 1.6, GAP, 1.4, 0.4, 0.02, 0.3);
    add_box(soup, GAP, 1.0, 1.2, 0.02, 1.2, 0.8);
    add_box(soup, SIDE - GAP - 0.01, 0.4, 1.3, 0.01, 0.5, 0.7);
    for (int k = 0; k < 2; k++)
        add_box(soup, SIDE - GAP - 0.3, 1.5 + k * (0.6 + GAP), 1.4, 0.3, 0.6, 0.4);
    add_box(soup, 1.2, 1.4, 0.72, 1.4, 0.8, 0.03);
    for (int k = 0; k < 4; k++)
        add_box(soup, k % 2 ? 2.53 : 1.22, k / 2 ? 2.13 : 1.42, GAP, 0.05, 0.05,
                0.72 - 2.0 * GAP);
    add_box(soup, 1.5, 1.5, 0.75 + GAP, 0.21, 0.3, 0.001);
    paint(soup, 0.4, 0.0);
    add_box(soup, 0.8, 1.0, GAP, 2.2, 1.6, 0.008);
    paint(soup, 0.3, 0.0);
}

/* Sixteen of them on one of two boards at the wall. */
static void add_books(struct soup *soup)
{
    struct random random = random_seed(1);
    double x = 1.0;
    for (int k = 0; k < 2; k++)
        add_box(soup, 1.0, 3.7 - GAP, 1.0 + 0.3 * k, 1.0, 0.3, 0.02);
    for (int i = 0; i < 16; i++) {
        double thick = random_between(&random, 0.02, 0.05);
        add_box(soup, x, 3.75, 1.02 + GAP, thick, 0.25 - 2.0 * GAP,
                random_between(&random, 0.2, 0.27));
        x += thick + GAP;
    }
    paint(soup, 0.3, 0.0);
}

static struct scene *room(void)
{
    struct soup soup = {0};
    add_shell(&soup);
    paint(&soup, 0.7, 0.0);
    add_lamps(&soup);
    add_things(&soup);
    add_books(&soup);
    return scene_of_soup(&soup);
}

/* The final gather sees the light of a leaf if it is at least this part of the mean: of
 * the fewest rays that a leaf has, 64, six then end in it if its surroundings have the
 * mean. */
static const double SEEN = 0.1;

enum { PATHS = 16, ROUNDS_LEAST = 8, ROUNDS_MOST = 8192 };

/* NOISY: wrong by a factor of two, but by at most twice the error that is said, five
 * deviations: of ten thousand leaves with few rays the worst is off by more than four. */
enum verdict { RIGHT, DIM, NOISY, WRONG, VERDICTS };

/* Light that a leaf reflects, and two and a half deviations, W/m^2. */
struct found {
    double light, error;
};

/* The light of a leaf by paths so far. */
struct traced {
    double sum, squares;
    int rounds;
};

static void trace_on(const struct pathtracer *pathtracer, struct patch_id id,
                     struct traced *traced)
{
    struct triangle part = pathtracer_part(id);
    uint64_t seed = id_number(id) * ROUNDS_MOST + (uint64_t)++traced->rounds;
    double b = pathtracer_reflected(pathtracer, (int32_t)id.root, &part, PATHS, seed)
                   .band[0];
    traced->sum += b;
    traced->squares += b * b;
}

/* The deviation of the mean. */
static double deviation_of(const struct traced *traced)
{
    double mean = traced->sum / traced->rounds;
    return sqrt(fmax(0.0, traced->squares / traced->rounds - mean * mean) /
                (traced->rounds - 1));
}

/* The leaf beside the truth: paths are traced until they tell, by four deviations of
 * their mean. NOISY and WRONG are said after all of them. */
static enum verdict judge_leaf(const struct pathtracer *pathtracer, struct patch_id id,
                               struct found found, double least)
{
    struct traced traced = {0};
    double light = found.light, truth = 0.0;
    while (traced.rounds < ROUNDS_MOST) {
        trace_on(pathtracer, id, &traced);
        truth = traced.sum / traced.rounds;
        if (traced.rounds < ROUNDS_LEAST)
            continue;
        double off = 4.0 * deviation_of(&traced);
        if (light < least && truth + off < least)
            return DIM;
        if (light <= 2.0 * (truth - off) && light >= 0.5 * (truth + off))
            return RIGHT;
    }
    if (fmax(light, truth) < least)
        return DIM;
    if (light <= 2.0 * truth && light >= 0.5 * truth)
        return RIGHT;
    return fabs(light - truth) <= 2.0 * found.error ? NOISY : WRONG;
}

static double reflected(const struct solution *s, int32_t patch)
{
    const struct forest *forest = s->solver->model.forest;
    return forest->radiosity[patch].band[0] -
           forest_material(forest, patch)->emission.band[0];
}

/* One leaf in 400 may be noisy: in a lamp's housing few rays find the slit of light. Of
 * every fourth leaf. */
static void test_room(void)
{
    struct solution s = solve_scene(room(), "");
    const struct forest *forest = s.solver->model.forest;
    struct pathtracer pathtracer = pathtracer_make(s.scene, s.octree);
    int counts[VERDICTS] = {0}, leaves = 0;
    double mean = forest_mean_reflected(forest) / BANDS;
    for (int32_t p = 0; p < forest->count; p++) {
        if (!patch_is_leaf(&forest->patches[p]) || leaves++ % 4 > 0)
            continue;
        struct found found = {reflected(&s, p),
                              (double)s.solver->beyond->answer->error[p]};
        counts[judge_leaf(&pathtracer, forest->patches[p].id, found, SEEN * mean)]++;
    }
    int seen = counts[RIGHT] + counts[NOISY] + counts[WRONG];
    tap_ok(s.vote.converged && counts[WRONG] <= 2 && counts[RIGHT] > counts[DIM],
           "a room with gaps of 2 mm: %d of %d leaves are wrong by a factor of two, %d "
           "are dim (%.1f s)",
           counts[WRONG], seen, counts[DIM], s.seconds);
    tap_ok(400 * counts[NOISY] <= seen, "%d more are, and their errors tell so",
           counts[NOISY]);
    pathtracer_free(&pathtracer);
    solution_free(&s);
}

enum holds { HELD, BROKEN, UNKNOWN, HOLDS };

/* Tells whether the leaf is off by its error at most: by paths, until their deviation is
 * a sixth of it, or UNKNOWN if it stays above a third. */
static enum holds error_holds(const struct pathtracer *pathtracer, struct patch_id id,
                              struct found found)
{
    enum { MOST = 512 };
    struct traced traced = {0};
    double off;
    do {
        trace_on(pathtracer, id, &traced);
        off = traced.rounds < ROUNDS_LEAST ? HUGE_VAL : deviation_of(&traced);
    } while (traced.rounds < MOST && off > found.error / 6.0);
    if (off > found.error / 3.0)
        return UNKNOWN;
    return fabs(found.light - traced.sum / traced.rounds) <= found.error ? HELD : BROKEN;
}

/* Errors are to hold for this part of the leaves that reflect. */
static void test_errors(struct scene *scene, const char *options, const char *name,
                        double part)
{
    enum { LOOKED = 600 };
    struct solution s = solve_scene(scene, options);
    const struct forest *forest = s.solver->model.forest;
    struct pathtracer pathtracer = pathtracer_make(s.scene, s.octree);
    int counts[HOLDS] = {0};
    int64_t step = forest->count / LOOKED + 1;
    for (int64_t p = step / 2; p < forest->count; p += step) {
        struct found found = {reflected(&s, (int32_t)p),
                              (double)s.solver->beyond->answer->error[p]};
        if (!patch_is_leaf(&forest->patches[p]) ||
            !(rgb_sum(forest_material(forest, (int32_t)p)->reflectance) > 0.0))
            continue;
        counts[error_holds(&pathtracer, forest->patches[p].id, found)]++;
    }
    int known = counts[HELD] + counts[BROKEN];
    tap_ok(4 * known > counts[UNKNOWN] && counts[HELD] >= part * known,
           "%s: errors hold for %d of %d leaves (%.1f s)", name, counts[HELD], known,
           s.seconds);
    pathtracer_free(&pathtracer);
    solution_free(&s);
}

/* A room whose window looks out on a ground and a black sky that shines. A table and
 * boxes. Far below there is a wide black plain: `lit`, or the face is turned down. */
static struct scene *room_to_the_sky(bool lit)
{
    struct soup soup = {0};
    soup_add_rectangle(&soup, point(0, 0, 0), point(4, 3, 0), 1);
    soup_add_rectangle(&soup, point(0, 0, HIGH), point(4, 3, HIGH), -1);
    soup_add_rectangle(&soup, point(0, 0, 0), point(0, 3, HIGH), 1);
    soup_add_rectangle(&soup, point(4, 0, 0), point(4, 3, HIGH), -1);
    soup_add_rectangle(&soup, point(0, 3, 0), point(4, 3, HIGH), -1);
    soup_add_rectangle(&soup, point(0, 0, 0), point(4, 0, 1), 1);
    soup_add_rectangle(&soup, point(0, 0, 2.2), point(4, 0, HIGH), 1);
    soup_add_rectangle(&soup, point(0, 0, 1), point(0.8, 0, 2.2), 1);
    soup_add_rectangle(&soup, point(3.2, 0, 1), point(4, 0, 2.2), 1);
    add_box(&soup, 1, 1, 0.7, 1.6, 0.8, 0.03);
    add_box(&soup, 1.2, 1.3, 0.731, 0.3, 0.3, 0.2);
    add_box(&soup, 3, 2, GAP, 0.6, 0.6, 1.2);
    add_box(&soup, 0.3, 2.4, GAP, 1.5, 0.5, 1.9);
    paint(&soup, 0.7, 0.0);
    soup_add_rectangle(&soup, point(-8, -6, -0.5), point(12, -0.2, -0.5), 1);
    paint(&soup, 0.3, 0.0);
    soup_add_rectangle(&soup, point(-8, -6, -3), point(12, -6, 12), 1);
    paint(&soup, 0.0, 5.0);
    soup_add_rectangle(&soup, point(-40, -6, -4), point(40, 40, -4), lit ? 1 : -1);
    paint(&soup, 0.0, 0.0);
    return scene_of_soup(&soup);
}

/* Noise of light that is not reflected is no error: all other rows are the same, but for
 * what the cuts of their regions have learnt, a tenth. */
static void test_black_plain(void)
{
    double by_rays[2];
    for (int lit = 0; lit < 2; lit++) {
        struct solution s =
            solve_scene(room_to_the_sky(lit), "--epsilon 1e-3 --final-gather 64");
        by_rays[lit] = s.solver->beyond->answer->counts.by_rays;
        solution_free(&s);
    }
    tap_ok(fabs(by_rays[1] / by_rays[0] - 1.0) <= 0.1,
           "light on a black plain makes an error by rays of %.2f %% one of %.2f %%",
           100.0 * by_rays[0], 100.0 * by_rays[1]);
}

/* Errors are to hold for 95 % of leaves; here they do for 97 and all. With two deviations
 * in place of two and a half it would be 93 % in the room with gaps, where half of all
 * leaves see little but the inside of one. */
static void test_room_errors(void)
{
    test_errors(room(), "--epsilon 1e-2 --final-gather 64", "gaps", 0.93);
    test_errors(room_to_the_sky(false), "--epsilon 1e-3 --final-gather 64", "sky",
                0.92); /* 94 %: those that see little of the sky */
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_room();
    test_room_errors();
    test_black_plain();
    comm_stop(&world_comm);
    return tap_done();
}
