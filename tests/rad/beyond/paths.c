/* The path tracer against exact answers. (Light paths: tests/whole/norms.c.)
 *
 * An estimate is random, so each is made RUNS times with other seeds; their mean is
 * compared with the exact answer. The tolerance is 5 standard deviations of the mean, as
 * the runs themselves scatter: a right tracer fails one check of two million. It must be
 * small beside the answer as well, or a check could not fail; each says how small. */
#include <math.h>

#include "geom/lambert.h"
#include "tools/pixel.h"
#include "tests/scenes.h"
#include "tests/tap.h"

enum { RUNS = 64, SAMPLES = 2048 };

static const struct triangle WHOLE = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const struct triangle CENTRE = {
    {{0.25, 0.25, 0.5}, {0.25, 0.25, 0.5}, {0.25, 0.25, 0.5}}};

struct outcome {
    double mean, sigma; /* of the mean */
};

/* rho H over a part of a root; with a camera, B of the middle of its 3 x 3 pixels. */
static struct outcome trace_by(const struct world *world, const struct camera *camera,
                               int32_t root, const struct triangle *part, int band,
                               const struct forest *guess)
{
    struct pathtracer pathtracer = pathtracer_make(world->scene, world->octree);
    pathtracer.guess = guess;
    double sum = 0.0, squares = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct rgb b = camera
                           ? pathtracer_pixel(&pathtracer, camera, 1, 1, SAMPLES, run)
                           : pathtracer_reflected(&pathtracer, root, part, SAMPLES, run);
        sum += b.band[band];
        squares += b.band[band] * b.band[band];
    }
    pathtracer_free(&pathtracer);
    double mean = sum / RUNS, variance = fmax(squares / RUNS - mean * mean, 0.0);
    return (struct outcome){mean, sqrt(variance / (RUNS - 1))};
}

static struct outcome trace(const struct world *world, int32_t root,
                            const struct triangle *part, int band)
{
    return trace_by(world, NULL, root, part, band, NULL);
}

/* `precise`: the largest standard deviation that is small enough, relative to the answer.
 * 1e-12 is rounding, for answers without noise. */
static void expect(struct outcome outcome, double exact, double precise, const char *what)
{
    tap_ok(fabs(outcome.mean - exact) <= 5.0 * outcome.sigma + 1e-12 * exact &&
               outcome.sigma <= precise * exact,
           "%s: %.5f, exact %.5f, standard deviation %.5f", what, outcome.mean, exact,
           outcome.sigma);
}

/* --- the furnace: B = E / (1 - rho) everywhere in a closed room --- */

static struct world furnace(bool two_sided)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(-1, -1, -1), point(1, 2, 1), 1, !two_sided);
    paint_with(&soup, (struct material){.reflectance = {{0.5, 0.8, 0.0}},
                                         .emission = {{1.0, 2.0, 3.0}}});
    struct scene *scene = scene_of_soup(&soup);
    scene->two_sided = scene->two_sided_lamps = two_sided;
    return world_make(scene);
}

static void test_furnace(void)
{
    struct world room = furnace(false);
    expect(trace(&room, 3, &WHOLE, 0), 1.0, 0.004,
           "furnace, rho 0.5, E 1: rho H over a root");
    expect(trace(&room, 3, &WHOLE, 1), 8.0, 0.004, "rho 0.8, E 2: rho H over a root");
    expect(trace(&room, 4, &CENTRE, 1), 8.0, 0.004, "rho 0.8, E 2: rho H at a point");
    expect(trace(&room, 3, &WHOLE, 2), 0.0, 0.0, "rho 0, E 3: rho H");
    world_free(&room);
}

/* From the middle of the room into a corner. */
static struct outcome trace_pixel(const struct world *world, int band)
{
    struct camera camera = {.eye = {0, 0.5, 0}, .at = {1, 2, 1}, .up = {0, 1, 0},
                            .fov = 90.0, .width = 3, .height = 3};
    return trace_by(world, &camera, 0, NULL, band, NULL);
}

static void test_pixel(void)
{
    struct world room = furnace(false), twins = furnace(true);
    expect(trace_pixel(&room, 1), 10.0, 0.004, "rho 0.8, E 2: E + rho H through a pixel");
    expect(trace_pixel(&room, 2), 3.0, 0.0, "rho 0, E 3: E through a pixel");
    expect(trace_pixel(&twins, 1), 10.0, 0.004, "two-sided furnace: through a pixel");
    world_free(&room);
    world_free(&twins);
}

/* Paths that take a guess for the light of all leaves find the same mean, right or wrong
 * as the guess is: `part` of the furnace's light, times `odd` on one child of a root. */
static void test_guess(double part, double odd, double precise, const char *what)
{
    struct world room = furnace(false);
    struct forest *forest = room.model.forest;
    for (int32_t root = 0; root < forest->root_count; root++)
        forest_split(forest, root);
    for (int32_t p = 0; p < forest->count; p++) {
        bool is_odd = p == forest->patches[forest->patches[p].id.root].children;
        double reflected = 8.0 * part * (is_odd ? odd : 1.0);
        forest->radiosity[p] = (struct rgb){{0.0, 2.0 + reflected, 0.0}};
    }
    expect(trace_by(&room, NULL, 3, &WHOLE, 1, forest), 8.0, precise, what);
    world_free(&room);
}

/* --- direct light --- */

/* A floor that reflects 0.5, a black light of side 1 with E = 4 at height 1 that faces
 * down, and on request a black screen halfway up. Under the centre of root 0, which is
 * (1, 0, 0), the screen hides the half of the light with y below 1/2. Of the light `seen`
 * is left, as a form factor. */
static struct soup lamp(bool with_screen, double *seen)
{
    struct soup soup = {0};
    struct vec3 x = {1, 0, 0}, y = {0, 1, 0};
    soup_add_quad(&soup, point(-2, -2, 0), vec3_scale(x, 4), vec3_scale(y, 4), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0, 0, 1), y, x, 1);
    paint(&soup, 0.0, 4.0);
    if (with_screen)
        soup_add_quad(&soup, point(0.25, -0.5, 0.5), x, vec3_scale(y, 0.75), 1);
    paint(&soup, 0.0, 0.0);
    double low = with_screen ? 0.5 : 0.0;
    struct vec3 light[4] = {{0, low, 1}, {0, 1, 1}, {1, 1, 1}, {1, low, 1}};
    *seen = point_polygon_factor(x, point(0, 0, 1), light, 4);
    return soup;
}

/* rho H under the centre of root 0 is this share of E = 4. Frees the triangles. */
static void expect_share(struct soup *soup, bool two_sided, bool two_sided_lamps,
                         double share, const char *what)
{
    struct scene *scene = scene_of_soup(soup);
    scene->two_sided = two_sided;
    scene->two_sided_lamps = two_sided_lamps;
    struct world world = world_make(scene);
    expect(trace(&world, 0, &CENTRE, 0), 0.5 * 4.0 * share, 0.004, what);
    world_free(&world);
}

/* The light upside down shows the floor its back, black without a twin. */
static void test_turned(void)
{
    for (int both = 0; both < 2; both++) {
        double seen;
        struct soup soup = lamp(false, &seen);
        for (int i = 2; i < 4; i++)
            soup.items[i] = reversed(soup.items[i]);
        expect_share(&soup, true, both, both ? seen : 0.0,
                     both ? "under its twin: rho H" : "under the back of a light: rho H");
    }
}

static void test_direct(void)
{
    double seen;
    struct soup soup = lamp(false, &seen);
    expect_share(&soup, false, false, seen, "under a square light: rho H");
    soup = lamp(true, &seen);
    expect_share(&soup, false, false, seen, "with half of it screened");
    soup = lamp(false, &seen);
    struct world open = world_make(scene_of_soup(&soup));
    expect(trace(&open, 2, &CENTRE, 0), 0.0, 0.0, "the light, which is black: rho H");
    world_free(&open);
}

/* A black ceiling in the plane of the light, behind it in the file: all points of the
 * light are seen through it, and no ray meets the light. */
static void test_flush(void)
{
    double seen;
    struct soup soup = lamp(false, &seen);
    soup_add_quad(&soup, point(-2, -2, 1), point(0, 4, 0), point(4, 0, 0), 1);
    paint(&soup, 0.0, 0.0);
    expect_share(&soup, false, false, seen,
                 "under a light that its ceiling hides: rho H");
}

int main(void)
{
    test_furnace();
    test_guess(1.0, 1.0, 0.001, "a right guess takes more than half of the noise");
    test_guess(1.0, 3.0, 0.004, "one that is wrong on parts of roots");
    test_guess(2.0, 1.0, 0.006, "one that is too bright");
    test_pixel();
    test_direct();
    test_flush();
    test_turned();
    return tap_done();
}
