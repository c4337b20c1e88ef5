/* The error norms on made-up samples, and the truth's elements and file. */
#include "tests/deviation.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "rad/pushpull.h"
#include "tests/scenes.h"
#include "tests/tap.h"

static const char *const FILE_NAME = "build/norms_test.ref";

static bool near(double value, double exact, double tolerance)
{
    return fabs(value - exact) <= tolerance;
}

static struct rgb grey(double value)
{
    return (struct rgb){{value, value, value}};
}

static struct sample sample_of(double area, double value, double truth)
{
    return (struct sample){area, grey(value), {grey(truth), grey(truth)}};
}

/* Areas 1, 2, 6 with errors 0.5, 1, 3 of truths 2, 4, 6 in each of three bands: squares
 * of errors 0.25 + 2 + 54 of 4 + 32 + 216; errors 0.5 + 2 + 18 of 2 + 8 + 36. More than
 * half the area has an error of 3; the mean truth is 46 / 9; the differences are 18 - 0.5
 * + 2. Numbers inexact in binary are within 1e-15. */
static void test_known(void)
{
    struct sample samples[3] = {sample_of(6, 9, 6), sample_of(1, 1.5, 2),
                                sample_of(2, 5, 4)};
    struct deviation d = deviation_of(samples, 3);
    tap_ok(near(d.rms, sqrt(56.25 / 252.0), 1e-15), "rms %.6f", d.rms);
    tap_ok(near(d.l1, 20.5 / 46.0, 1e-15), "l1 %.6f", d.l1);
    tap_ok(near(d.median, 27.0 / 46.0, 1e-15), "median %.6f", d.median);
    tap_ok(near(d.bias, 19.5 / 46.0, 1e-15), "bias %.6f", d.bias);
    tap_ok(d.noise == 0.0 && near(d.square, 84.0, 1e-12), "no noise; mean square %g",
           d.square);
}

static void test_ends(void)
{
    struct sample black[2] = {sample_of(1, 0, 3), sample_of(3, 0, 3)};
    struct deviation d = deviation_of(black, 2);
    tap_ok(d.rms == 1.0 && d.l1 == 1.0 && d.median == 1.0 && d.bias == -1.0,
           "a black solution has errors of 1 and has lost all");
    struct sample right[2] = {sample_of(1, 5, 5), sample_of(3, 2, 2)};
    d = deviation_of(right, 2);
    tap_ok(d.rms == 0.0 && d.l1 == 0.0 && d.median == 0.0, "the right solution has none");
    struct sample between = {1.0, grey(2.0), {grey(1.0), grey(3.0)}};
    d = deviation_of(&between, 1);
    tap_ok(d.rms == 0.0 && near(d.noise, sqrt(1.0 / 3.0), 1e-15),
           "an answer between the two estimates has an rms of 0");
    /* One band has all the error: bands are added before the root and the median. */
    struct sample band = {1.0, {{1, 2, 5}}, {{{1, 2, 2}}, {{1, 2, 2}}}};
    d = deviation_of(&band, 1);
    tap_ok(near(d.rms, 1.0, 1e-15) && near(d.l1, 0.6, 1e-15) &&
               near(d.median, 0.6, 1e-15),
           "bands are added: %.3f, %.3f, %.3f", d.rms, d.l1, d.median);
    d = deviation_of(NULL, 0);
    tap_ok(d.rms == 0.0 && d.noise == 0.0, "no samples, no error");
}

enum { MANY = 100000 };

/* Truth 1, even noise of +-0.5 in each half (variance 1/12), solution off by 0.1. The rms
 * is sqrt(mean of (0.1 + a)(0.1 + b)): the mean has a standard deviation of about 1/12 /
 * sqrt(3 MANY), 1.5e-4, on 0.01; 5 of them are 4 % of the rms. A biased sum would give
 * 0.1 + noise: 0.23. */
static void test_noise(void)
{
    struct sample *samples = alloc_array(MANY, sizeof *samples);
    struct random random = random_seed(1);
    for (int i = 0; i < MANY; i++) {
        samples[i] = sample_of(1.0, 1.1, 0.0);
        for (int c = 0; c < BANDS; c++)
            for (int half = 0; half < TRUTH_HALVES; half++)
                samples[i].truth[half].band[c] = 0.5 + random_unit(&random);
    }
    struct deviation d = deviation_of(samples, MANY);
    tap_ok(near(d.rms, 0.1, 0.004), "noise does not bias the rms: %.4f, exact 0.1",
           d.rms);
    tap_ok(near(d.noise, sqrt(1.0 / 24.0), 0.002), "the noise is known: %.4f, exact %.4f",
           d.noise, sqrt(1.0 / 24.0)); /* itself known to 0.2 % */
    tap_ok(d.l1 > 0.15, "the l1 carries it: %.4f", d.l1);
    for (int i = 0; i < MANY; i++)
        samples[i].value = grey(1.0);
    tap_ok(deviation_of(samples, MANY).rms < 0.03,
           "no error: rms near 0 whatever the noise");
    alloc_free(samples);
}

/* Two triangles in the plane z = 0 with areas 2 and 4, both with E = 0.5. */
static struct world two_roots(void)
{
    struct soup soup = {0};
    soup_add(&soup, (struct triangle){{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}}});
    soup_add(&soup, (struct triangle){{{2, -1, 0}, {6, -1, 0}, {2, 1, 0}}});
    paint(&soup, 0.5, 0.5);
    return world_make(scene_of_soup(&soup));
}

/* Truth of root 0: 3 and 5 in turn, swapped in the other half, so 4 without noise over
 * any patch of several elements. Of root 1: 5 and 3 for the halves, so 4 with a noise of
 * 1. */
static struct truth two_truths(const struct scene *scene)
{
    struct truth truth = truth_make(scene, 32);
    for (int64_t i = 0; i < truth.count; i++) {
        int64_t turn = truth.items[i].id.root == 0 ? i & 1 : 0;
        truth.items[i].mean[0] = grey(turn ? 3.0 : 5.0);
        truth.items[i].mean[1] = grey(turn ? 5.0 : 3.0);
    }
    return truth;
}

/* B - E is 1, 2, 3, 6 on the children of root 0, whose mean is off by -1, and 6 on root
 * 1, which is not divided: off by 2, its product of deviations 1 * 3. Squares of truths
 * are 16 and 5 * 3. All weighted with the areas 2 and 4. */
static void test_roots(void)
{
    static const double reflected[4] = {1.0, 2.0, 3.0, 6.0};
    struct world world = two_roots();
    struct forest *forest = world.model.forest;
    struct truth truth = two_truths(world.scene);
    forest_split(forest, 0);
    for (int k = 0; k < 4; k++)
        forest->radiosity[forest->patches[0].children + k] =
            grey(0.5 + reflected[k]);
    patch_average(forest, 0, forest->radiosity);
    forest->radiosity[1] = grey(0.5 + 6.0);
    struct deviation root = deviation_of_roots(forest, &truth);
    struct deviation leaf = deviation_of_leaves(forest, &truth);
    tap_ok(truth.count == 16 + 64, "roots of 16 and 64 elements");
    tap_ok(near(root.rms, sqrt((2.0 + 12.0) / 92.0), 1e-15), "root rms %.6f", root.rms);
    tap_ok(near(root.l1, 10.0 / 24.0, 1e-15), "root l1 %.6f", root.l1);
    tap_ok(near(root.median, 0.5, 1e-15), "root median %.6f", root.median);
    tap_ok(near(root.bias, 6.0 / 24.0, 1e-15), "root bias %.6f", root.bias);
    tap_ok(near(root.noise, sqrt(4.0 / 92.0), 1e-15), "root noise %.6f", root.noise);
    tap_ok(
        near(leaf.rms, sqrt((2.0 * 18.0 / 4.0 + 12.0) / 92.0), 1e-15) &&
            near(leaf.l1, 12.0 / 24.0, 1e-15) && near(leaf.bias, root.bias, 1e-15),
        "leaf rms %.6f, l1 %.6f: errors inside a root count, the bias is that of roots",
        leaf.rms, leaf.l1);
    truth_free(&truth);
    world_free(&world);
}

/* A floor, a wall and a black light, of two triangles each, and a sheet on the floor;
 * `below`: the floor is seen by a twin. */
static struct world floor_and_light(bool sheet, bool below)
{
    struct soup soup = {0};
    struct vec3 x = {2, 0, 0}, y = {0, 2, 0};
    soup_add_quad(&soup, point(-1, -1, 0), below ? y : x, below ? x : y, 1);
    soup_add_quad(&soup, point(-1, -1, 1), y, x, 1);
    soup_add_quad(&soup, point(-1, -1, 0), y, point(0, 0, 1), 1);
    if (sheet)
        soup_add_quad(&soup, point(-0.7, -0.4, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.8, 0.0);
    paint(&soup, 0.0, 1.0);
    struct scene *scene = scene_of_soup(&soup);
    scene->material_of[2] = scene->material_of[3] = 1;
    scene->two_sided = below;
    return world_make(scene);
}

static void test_elements(const struct scene *scene, const struct truth *truth)
{
    bool ordered = true, inside = true;
    for (int64_t i = 0; i < truth->count; i++) {
        const struct element *e = &truth->items[i];
        ordered = ordered && (i == 0 || id_compare(truth->items[i - 1].id, e->id) < 0);
        double w[3] = {e->weight[0], e->weight[1], e->weight[2]};
        for (int step = 0; step < id_level(e->id); step++) {
            int child = id_step(e->id, step);
            for (int k = 0; k < 3; k++)
                w[k] = child == 3 ? 1.0 - 2.0 * w[k] : 2.0 * w[k] - (k == child);
        }
        inside =
            inside && fmin(w[0], fmin(w[1], w[2])) >= -1e-12; /* rounding times 4^2 */
    }
    tap_ok(truth->count == 64, "4 of 6 roots reflect, 16 elements each: %lld",
           (long long)truth->count);
    tap_ok(ordered, "elements are in the order of IDs");
    tap_ok(inside, "each has its point inside");
    double noise = truth_noise(truth, scene, false);
    tap_ok(noise > 0.0 && truth_noise(truth, scene, true) > 0.0,
           "the means have noise, and so have the points");
}

static void test_file(const struct scene *scene, const struct truth *truth)
{
    struct truth copy = {0};
    struct error error = {0};
    bool same =
        truth_write(truth, FILE_NAME, &error) &&
        truth_read(&copy, FILE_NAME, scene, &error) && copy.count == truth->count &&
        memcmp(copy.items, truth->items, (size_t)copy.count * sizeof *copy.items) == 0;
    tap_ok(same, "a file gives back the truth written");
    truth_free(&copy);
    struct scene other = *scene;
    double areas[6];
    for (int k = 0; k < 6; k++)
        areas[k] = 2.0 * scene->areas[k];
    other.areas = areas;
    tap_ok(!truth_read(&copy, FILE_NAME, &other, &error) && error.code == EXIT_USAGE,
           "the reference of another scene is refused: %s", error.text);
    remove(FILE_NAME);
    error.code = EXIT_DONE;
    tap_ok(!truth_read(&copy, FILE_NAME, scene, &error) && error.code == EXIT_USAGE,
           "and so is none: %s", error.text);
}

/* Light paths and paths from the elements agree, also on twins and where a face lies on
 * another. The product of two halves whose noise is 1.2 %, over 32 elements, deviates by
 * a sixth of the square of 1 %. */
static void test_means(const struct comm *comm, const struct world *world)
{
    struct truth truth = truth_trace(comm, world->scene, world->octree, 32,
                                     (struct truth_paths){16384, 4096});
    struct pathtracer pathtracer = pathtracer_make(world->scene, world->octree);
    struct sample *samples = alloc_array((size_t)truth.count, sizeof *samples);
    for (int64_t i = 0; i < truth.count; i++) {
        const struct element *e = &truth.items[i];
        struct triangle part = pathtracer_part(e->id);
        samples[i] = (struct sample){
            element_area(e, world->scene),
            pathtracer_reflected(&pathtracer, (int32_t)e->id.root, &part, 4096,
                                 (UINT64_C(1) << 40) + (uint64_t)i),
            {e->mean[0], e->mean[1]}};
    }
    struct deviation d = deviation_of(samples, truth.count);
    tap_ok(d.noise < 0.02 && d.rms < 0.01 && fabs(d.bias) < 0.005,
           "means by light paths: noise %.4f, off by %.4f from those by paths, bias %.4f",
           d.noise, d.rms, d.bias);
    alloc_free(samples);
    pathtracer_free(&pathtracer);
    truth_free(&truth);
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    test_known();
    test_ends();
    test_noise();
    test_roots();
    struct world world = floor_and_light(false, false),
                 sheet = floor_and_light(true, false),
                 below = floor_and_light(false, true);
    struct truth truth = truth_trace(&comm, world.scene, world.octree, 32,
                                     (struct truth_paths){64, 16});
    test_elements(world.scene, &truth);
    test_file(world.scene, &truth);
    test_means(&comm, &world);
    test_means(&comm, &sheet);
    test_means(&comm, &below);
    truth_free(&truth);
    world_free(&world);
    world_free(&sheet);
    world_free(&below);
    comm_stop(&comm);
    return tap_done();
}
