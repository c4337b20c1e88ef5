/* Tests of io/picture/render.h: light gathered at the points that pictures show, against
 * closed forms, where no mesh could show them. */
#include "mpi/beyond/beyond.h"
#include "io/picture/render.h"

#include "geom/alloc.h"
#include "geom/lambert.h"
#include "rad/beyond/sample.h"
#include "tests/defaults.h"
#include "tests/tap.h"

/* Radiosity at a point of root `first` or the next, as a picture shows it; `shading`
 * NULL: all light is gathered. */
static double shown(struct solution *s, const struct shading *shading, int32_t first,
                    struct vec3 at)
{
    struct renderer renderer =
        renderer_make(s->octree, shading, s->solver->beyond->answer->gather);
    struct vec3 x = scene_from_input(s->scene, at);
    for (int32_t root = first; root < first + 2; root++) {
        double weight[3];
        struct triangle t = scene_root_triangle(s->scene, root);
        triangle_weights(&t, x, weight);
        if (fmin(weight[0], fmin(weight[1], weight[2])) >= -1e-9)
            return render_point(&renderer, root, weight, 1).band[0];
    }
    return -1.0;
}

static struct shading *shade_rest(const struct solution *s)
{
    const struct answer *answer = s->solver->beyond->answer;
    return shading_create(s->solver->model.forest, s->octree, answer->straight,
                          answer->error, answer->open);
}

/* --- straight from a lamp --- */

/* The factor from a point of the floor to a part of the lamp. */
static double factor_to_lamp(struct vec3 x, double from, double to)
{
    const struct vec3 a = {from, -0.1, 1}, b = {to, -0.1, 1}, c = {to, 0.1, 1},
                      d = {from, 0.1, 1};
    const struct triangle parts[2] = {{{a, d, c}}, {{a, c, b}}};
    return point_triangle_factor(x, point(0, 0, 1), &parts[0]) +
           point_triangle_factor(x, point(0, 0, 1), &parts[1]);
}

/* A square floor of two leaves with this half side, a square lamp above, of which a plate
 * of half side `half`, halfway between, hides some, with so many rays; 0: there is no
 * plate. */
static struct solution half_shadow(int rays, double floor, double half)
{
    char words[64];
    struct soup soup = {0};
    soup_add_quad(&soup, point(-floor, -floor, 0), point(2 * floor, 0, 0),
                  point(0, 2 * floor, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(-0.1, -0.1, 1), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    paint(&soup, 0.0, 100.0);
    if (half > 0.0) {
        soup_add_quad(&soup, point(-half, -half, 0.5), point(2 * half, 0, 0),
                      point(0, 2 * half, 0), 1);
        paint(&soup, 0.0, 0.0);
    }
    snprintf(words, sizeof words, "--max-level 0 --final-gather %d", rays);
    return solve_soup(&soup, words);
}

/* The shadow has its edges where they are, although no leaf knows of them. Of
 * 16 points in squares of their own the half-shadow's edge may cut some 4, of 1,024 some
 * 32: segments are a quarter of the rays at least. */
static void test_shadow(bool all, int rays, double allowed)
{
    struct solution s = half_shadow(rays, 1.0, 0.2);
    struct shading *shading = all ? NULL : shade_rest(&s);
    double lit = 0.0, dark = 0.0, half = 0.0;
    for (int i = 0; i <= 10; i++) {
        struct vec3 x = point(0.501 + 0.04 * i, 0.03 * i, 0.0);
        double exact = 50.0 * factor_to_lamp(x, -0.1, 0.1);
        lit = fmax(lit, fabs(shown(&s, shading, 0, x) / exact - 1.0));
        dark = fmax(dark, shown(&s, shading, 0, point(0.0299 * i, -0.02 * i, 0.0)));
        x = point(0.4, 0.015 * i, 0.0); /* sees the half of the lamp that is x > 0 */
        exact = 50.0 * factor_to_lamp(x, 0.0, 0.1);
        half = fmax(half, fabs(shown(&s, shading, 0, x) / exact - 1.0));
    }
    const char *light = all ? "all light gathered" : "light straight from lamps";
    tap_ok(lit <= 1e-6, "%s: lit points are right within %.1e", light, lit);
    tap_ok(dark == 0.0, "%s: shadow is dark", light);
    tap_ok(half <= allowed, "%s: half-shadow is right within %.1e", light, half);
    shading_destroy(shading);
    solution_free(&s);
}

/* Segments that a pixel at a point of the floor fires. */
static int64_t segments_at(struct solution *s, const struct shading *shading,
                           struct vec3 x)
{
    const struct gather_counts *counts = &s->solver->beyond->answer->gather->counts;
    int64_t before = counts->segments;
    shown(s, shading, 0, x);
    return counts->segments - before;
}

/* A pixel that is sure has 4 segments. Where the mesh, here of two leaves, has another
 * light, or some segments are blocked, the pixel has a quarter to all of the rays from a
 * leaf besides. */
static void test_noise(void)
{
    struct solution even = half_shadow(4096, 0.05, 0.0), s = half_shadow(4096, 1.0, 0.2);
    struct shading *of_even = shade_rest(&even), *shading = shade_rest(&s);
    int64_t sure = segments_at(&even, of_even, point(0.03, 0.01, 0.0));
    int64_t noisy = segments_at(&s, shading, point(0.43, 0.015, 0.0));
    int64_t lit = segments_at(&s, shading, point(0.7, 0.1, 0.0));
    tap_ok(sure == 4, "a pixel that is sure has %lld segments", (long long)sure);
    tap_ok(noisy >= 4 + 1024 && noisy <= 4 + 4096, "a noisy one has %lld",
           (long long)noisy);
    tap_ok(lit == 4 + 1024, "one far from the mesh has %lld", (long long)lit);
    shading_destroy(of_even);
    shading_destroy(shading);
    solution_free(&even);
    solution_free(&s);
}

/* Noisy pixels deviate by a part of their light that a display hardly shows, at 100
 * points in view of half the lamp: by .015 of the geometric mean of the light here and in
 * the scene, which is less: so by .02 of the light here at most. */
static void test_deviation(void)
{
    struct solution s = half_shadow(256, 1.0, 0.2);
    struct shading *shading = shade_rest(&s);
    double square = 0.0;
    for (int i = 0; i < 100; i++) {
        struct vec3 x = point(0.4, 0.0015 * i, 0.0);
        double exact = 50.0 * factor_to_lamp(x, 0.0, 0.1);
        double off = shown(&s, shading, 0, x) / exact - 1.0;
        square += off * off / 100.0;
    }
    tap_ok(square <= 0.02 * 0.02, "half-shadow: pixels deviate by %.4f", sqrt(square));
    shading_destroy(shading);
    solution_free(&s);
}

static int compare_values(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Inner pixels off the median of the 3 x 3 around by more than a tenth, where five of
 * these differ by less. */
static int count_specks(const float *rgb, int size)
{
    int specks = 0;
    for (int i = size; i < size * (size - 1); i++) {
        double around[9], own = (double)rgb[3 * i];
        if (i % size == 0 || i % size == size - 1)
            continue;
        for (int k = 0; k < 9; k++)
            around[k] = (double)rgb[3 * (i + size * (k / 3 - 1) + k % 3 - 1)];
        qsort(around, 9, sizeof *around, compare_values);
        specks += around[6] < 1.1 * around[2] && fabs(own / around[4] - 1.0) > 0.1;
    }
    return specks;
}

/* A ball of 128 shining facets in a room, before even walls: four segments choose among
 * facets of several directions. */
static void test_specks(void)
{
    enum { SIZE = 96 };
    struct soup soup = {0};
    soup_add_sphere(&soup, 0.15, 2);
    paint(&soup, 0.0, 20.0);
    soup_add_box(&soup, point(-2.5, -2.2, -2.2), point(1.5, 1.8, 0.8), 1, true);
    paint(&soup, 0.7, 0.0);
    struct solution s = solve_soup(&soup, "");
    struct shading *shading = shade_rest(&s);
    struct renderer renderer =
        renderer_make(s.octree, shading, s.solver->beyond->answer->gather);
    struct camera camera = {.eye = point(-2.2, -2, -0.7), .at = point(1, 0.5, -0.8),
                            .up = point(0, 0, 1), .fov = 70.0,
                            .width = SIZE, .height = SIZE};
    float *rgb = render_scanlines(&renderer, &camera, 2, 0, 1, NULL);
    int specks = count_specks(rgb, SIZE);
    alloc_free(rgb);
    tap_ok(specks <= 2, "walls beside a lamp of many facets have %d specks", specks);
    shading_destroy(shading);
    solution_free(&s);
}

/* --- all light --- */

/* Everything shines as it absorbs: B = 1 at every point, in corners and gaps too. */
static void test_furnace(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(0.3, 0.3, 0.01), point(0.7, 0.6, 0.5), 1, false);
    paint(&soup, 0.5, 0.5);
    struct solution s = solve_soup(&soup, "--epsilon 1e-2");
    struct renderer renderer =
        renderer_make(s.octree, NULL, s.solver->beyond->answer->gather);
    double worst = 0.0;
    int points = 0;
    for (int32_t root = 0; root < scene_root_count(s.scene); root++)
        for (int k = 0; k < 16; k++, points++) {
            double u = (k % 4 + 0.01) / 4.0, v = (k / 4 + 0.01) / 4.0;
            const double weight[3] = {1.0 - u, u * v, u * (1.0 - v)};
            double b = render_point(&renderer, root, weight, (uint64_t)k).band[0];
            worst = fmax(worst, fabs(b - 1.0));
        }
    /* the tolerance of the solution is 1e-5 of all light */
    tap_ok(worst <= 2e-5, "a furnace is even at %d points, within %.1e", points, worst);
    solution_free(&s);
}

/* A furnace with a box that leaves a strip of the floor along the walls: the strip shines
 * as all does, though the two leaves of the floor are dark in the mean. A wide strip is
 * interpolated, which takes less time and has no noise: what a leaf has and the part of
 * it that is open are found by the same rays. */
static void test_strip(double width, bool is_narrow)
{
    double end = 1.0 - width, worst = 0.0;
    int32_t leaf;
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(width, width, -0.1), point(end, end, 0.5), 1, false);
    paint(&soup, 0.5, 0.5);
    struct solution s = solve_soup(&soup, "--max-level 0");
    struct shading *shading = shade_rest(&s);
    int32_t floor = 0;
    while (scene_root_plane(s.scene, floor).normal.z < 0.9)
        floor += 2;
    for (int i = 1; i < 20; i++)
        worst = fmax(worst,
                     fabs(shown(&s, shading, floor, point(0.05 * i, 0.02, 0)) - 1.0));
    leaf = leaf_at(s.solver->model.forest, floor, (double[]){1.0, 0.0, 0.0});
    bool covered = shading->shades[leaf] == SHADE_COVERED;
    tap_ok(worst > 0.0 && worst <= (is_narrow ? 0.02 : 0.015) && covered == is_narrow,
           "a strip of floor beside a box is even within %.1e", worst);
    shading_destroy(shading);
    solution_free(&s);
}

/* A slot between a wall and a box that covers most of the floor, deeper than wide. Few
 * of the rays from its bottom get out of it, so more are fired: 1 + 4 times 128, each of
 * which meets two faces or more. */
static void test_slot(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(0.05, 0.05, -0.1), point(0.95, 0.95, 0.3), 1, false);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.3, 0.3, 0.999), point(0, 0.4, 0), point(0.4, 0, 0), 1);
    paint(&soup, 0.0, 10.0);
    struct solution s = solve_soup(&soup, "--max-level 0");
    struct shading *shading = shade_rest(&s);
    const struct gather_counts *counts = &s.solver->beyond->answer->gather->counts;
    int32_t floor = 0;
    while (scene_root_plane(s.scene, floor).normal.z < 0.9)
        floor += 2;
    int64_t before = counts->rays;
    double light = shown(&s, shading, floor, point(0.3, 0.02, 0));
    tap_ok(light > 0.0 && counts->rays - before >= 5 * 2 * 128,
           "in a slot light is looked for again: %.3f W/m^2 (%lld rays)", light,
           (long long)(counts->rays - before));
    shading_destroy(shading);
    solution_free(&s);
}

/* Radiosity of a floor of two leaves, half of which is below a board with its underside
 * at `low`, beside it. */
static double light_beside_board(double low)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    soup_add_box(&soup, point(0.05, 0.05, low), point(0.95, 0.6, 0.1), 1, false);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.3, 0.3, 0.999), point(0, 0.4, 0), point(0.4, 0, 0), 1);
    paint(&soup, 0.0, 10.0);
    struct solution s = solve_soup(&soup, "--max-level 0 --final-gather 1024");
    struct shading *shading = shade_rest(&s);
    int32_t floor = 0;
    while (scene_root_plane(s.scene, floor).normal.z < 0.9)
        floor += 2;
    double light = shown(&s, shading, floor, point(0.7, 0.85, 0));
    shading_destroy(shading);
    solution_free(&s);
    return light;
}

/* A board that hangs close to the floor keeps as much light off as one that stands on it:
 * the dark of the gap is not that of the rest. */
static void test_gap(void)
{
    double stands = light_beside_board(-0.1), hangs = light_beside_board(0.005);
    tap_ok(stands > 0.0 && fabs(hangs / stands - 1.0) <= 0.03,
           "beside a gap the floor has %.3f W/m^2, beside none %.3f", hangs, stands);
}

/* --- smooth surfaces --- */

/* A column of eight facets, a small lamp far away: light falls as the cosine of the
 * smooth surface, beyond the horizon of the facets too. */
static void test_column(void)
{
    static const double FAR = 40.0, TURN = 0.17453292519943295; /* 10 degrees */
    struct soup soup = {0};
    struct vec3 rim[8];
    for (int i = 0; i < 8; i++) {
        double angle = TURN * (3.0 + 4.5 * i);
        rim[i] = point(cos(angle), sin(angle), 0);
    }
    for (int i = 0; i < 8; i++)
        soup_add_quad(&soup, rim[i], vec3_sub(rim[(i + 1) % 8], rim[i]), point(0, 0, 1),
                      1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(FAR, -0.2, 0.3), point(0, 0, 0.4), point(0, 0.4, 0), 1);
    paint(&soup, 0.0, 1e4);
    struct scene *scene = scene_of_soup(&soup);
    scene_add_normals(scene);
    for (int i = 0; i < 16; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 corner = scene->triangles[i].corner[k];
            scene->normals[3 * i + k] = point(corner.x, corner.y, 0);
        }
    struct solution s = solve_scene(scene, "--epsilon 1e-2 --final-gather 64");
    struct shading *shading = shade_rest(&s);
    double brightest = 0.5 * 1e4 * 0.16 / (PI * (FAR - 1) * (FAR - 1));
    double worst = 0.0;
    for (int facet = 6; facet < 10; facet++) /* 300 to 480 degrees */
        for (int k = 1; k < 8; k++) {
            struct vec3 a = rim[facet % 8], b = rim[(facet + 1) % 8];
            struct vec3 x =
                vec3_add(vec3_scale(a, 1.0 - k / 8.0), vec3_scale(b, k / 8.0));
            double cosine = fmax(0.0, x.x / vec3_length(x));
            double off =
                shown(&s, shading, 2 * (facet % 8), vec3_add(x, point(0, 0, 0.5))) /
                    brightest -
                cosine;
            worst = fmax(worst, fabs(off));
        }
    tap_ok(worst <= 0.05,
           "a column of facets is lit as a round one, within %.3f of the most", worst);
    shading_destroy(shading);
    solution_free(&s);
}

/* A facet of a bowl, whose normals lean to its middle, and a lamp behind it: some of its
 * tangent planes are open to the lamp, but it is in the way itself. */
static void test_bowl(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(0, 1, 0), point(0, 0, 1), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(-0.6, 3, 0.4), point(0.2, 0, 0), point(0, 0, 0.2), 1);
    paint(&soup, 0.0, 1e3);
    struct scene *scene = scene_of_soup(&soup);
    scene_add_normals(scene);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            double middle = scene_from_input(scene, point(0, 0.5, 0)).y;
            bool left = scene->triangles[i].corner[k].y < middle;
            scene->normals[3 * i + k] = point(0.8, left ? 0.6 : -0.6, 0);
        }
    struct solution s = solve_scene(scene, "--epsilon 1e-2 --final-gather 64");
    struct shading *shading = shade_rest(&s);
    double most = 0.0;
    for (int i = 1; i < 20; i++)
        most = fmax(most, fabs(shown(&s, shading, 0, point(0, 0.05 * i, 0.53))));
    tap_ok(most == 0.0, "no light comes through the facet of a bowl: %g", most);
    shading_destroy(shading);
    solution_free(&s);
}

/* A box whose normals are smoothed over its edges, as some programs write them: a plate
 * above it keeps the light of a lamp off. */
static void test_smoothed_box(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(-0.5, -0.5, -0.5), point(0.5, 0.5, 0.5), 1, false);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(-1, -1, 0.7), point(2, 0, 0), point(0, 2, 0), 1);
    paint(&soup, 0.0, 0.0);
    soup_add_quad(&soup, point(-0.2, -0.2, 2), point(0, 0.4, 0), point(0.4, 0, 0), 1);
    paint(&soup, 0.0, 100.0);
    struct scene *scene = scene_of_soup(&soup);
    scene_add_normals(scene);
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < 3; k++)
            scene->normals[3 * i + k] = vec3_unit(scene->triangles[i].corner[k]);
    struct solution s = solve_scene(scene, "--epsilon 1e-2 --final-gather 64");
    struct shading *shading = shade_rest(&s);
    double most = 0.0;
    for (int32_t root = 0; root < 12; root += 2)
        for (int i = 0; i < 9; i++) {
            struct vec3 x = point(0.1 * i - 0.4, 0.03 * i, 0.5);
            if (scene_root_plane(s.scene, root).normal.z > 0.9)
                most = fmax(most, shown(&s, shading, root, x));
        }
    tap_ok(most == 0.0, "a smoothed box under a plate is dark: %.2g", most);
    shading_destroy(shading);
    solution_free(&s);
}

/* --- walls without thickness --- */

/* Two sealed rooms with so much wall between them, 0: none; a lamp is in the first. Their
 * sides are of n x n cells; n = 0: both have one floor, one ceiling and two long walls in
 * common. All is turned by this quaternion. */
static struct scene *two_rooms(double wall, int n, const double turn[4])
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0.6, 0.3, 0.9), point(0, 0.4, 0), point(0.3, 0, 0), 1);
    paint(&soup, 0.0, 100.0);
    if (n > 0) {
        soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), n, true);
        soup_add_box(&soup, point(1 + wall, 0, 0), point(2 + wall, 1, 1), n, true);
    } else {
        soup_add_box(&soup, point(0, 0, 0), point(2, 1, 1), 1, true);
        soup_add_quad(&soup, point(1, 0, 0), point(0, 1, 0), point(0, 0, 1), 1);
        soup_add_quad(&soup, point(1, 0, 0), point(0, 0, 1), point(0, 1, 0), 1);
    }
    paint(&soup, 0.5, 0.0);
    for (int64_t i = 0; i < soup.count; i++)
        for (int k = 0; k < 3; k++)
            soup.items[i].corner[k] = turned(soup.items[i].corner[k], turn);
    return scene_of_soup(&soup);
}

/* What is seen of the rooms. */
struct rooms_seen {
    double dark;    /* brightest pixel of a picture from inside of the dark room */
    double corner;  /* brightest vertex there */
    double lit[24]; /* means of 6 x 4 blocks of 8 x 8 pixels in the lit room */
};

static struct rooms_seen see_rooms(struct scene *scene, const double turn[4],
                                   const char *words)
{
    enum { WIDTH = 48, HEIGHT = 32 };
    struct rooms_seen seen = {0.0, 0.0, {0.0}};
    struct solution s = solve_scene(scene, words);
    const struct forest *forest = s.solver->model.forest;
    const struct answer *answer = s.solver->beyond->answer;
    struct shading *shading = shade_rest(&s);
    struct renderer renderer =
        renderer_make(s.octree, shading, answer->straight ? answer->gather : NULL);
    for (int dark = 0; dark < 2; dark++) {
        struct camera camera = {
            .eye = turned(dark ? point(1.95, 0.05, 0.6) : point(0.05, 0.05, 0.6), turn),
            .at = turned(dark ? point(1.05, 0.6, 0.4) : point(0.95, 0.6, 0.4), turn),
            .up = turned(point(0, 0, 1), turn), .fov = 75.0,
            .width = WIDTH, .height = HEIGHT};
        float *rgb = render_scanlines(&renderer, &camera, 1, 0, 1, NULL);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            double value = (double)rgb[3 * i];
            if (dark)
                seen.dark = fmax(seen.dark, value);
            else
                seen.lit[i / WIDTH / 8 * 6 + i % WIDTH / 8] += value / 64.0;
        }
        alloc_free(rgb);
    }
    struct vec3 along = turned(point(1, 0, 0), turn);
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf)) {
        struct triangle t = forest_triangle(forest, leaf);
        struct vec3 x = scene_to_input(s.scene, triangle_centroid(&t));
        for (int k = 0; k < 3 && vec3_dot(x, along) > 1.0 + 1e-9; k++) {
            int32_t vertex = shading->corners[3 * leaf + k];
            seen.corner = fmax(seen.corner, shading->values[vertex].band[0]);
        }
    }
    shading_destroy(shading);
    solution_free(&s);
    return seen;
}

/* The dark room is dark, at all pixels and vertices, also along the wall, and the lit one
 * is as bright as with 10 cm of wall between. Turned, the ends of the wall's edges have
 * rounded coordinates. */
static void test_wall(const char *name, int n, const double turn[4], const char *words)
{
    struct rooms_seen thin = see_rooms(two_rooms(0.0, n, turn), turn, words);
    struct rooms_seen thick = see_rooms(two_rooms(0.1, n, turn), turn, words);
    double worst = 0.0;
    for (int i = 0; i < 24; i++)
        worst = fmax(worst, fabs(thin.lit[i] / thick.lit[i] - 1.0));
    tap_ok(thin.dark == 0.0 && thin.corner == 0.0,
           "%s, %s: no light behind the wall (pixels %.1e, vertices %.1e)", name, words,
           thin.dark, thin.corner);
    tap_ok(worst <= 0.015, "and before it blocks are off by %.4f at most", worst);
}

/* A wall that stands on the inside of a floor, along edges of its leaves. Links to leaves
 * on both sides of it have left some light. */
static void test_common_floor(const double turn[4], const char *words)
{
    struct rooms_seen seen = see_rooms(two_rooms(0.0, 0, turn), turn, words);
    double most = 1e-4 * seen.lit[9];
    tap_ok(seen.dark <= most && seen.corner <= most,
           "a floor in common, %s: pixels %.1e, vertices %.1e behind the wall", words,
           seen.dark, seen.corner);
}

static void test_walls(void)
{
    static const char *const words[] = {"--epsilon 1e-3",
                                        "--epsilon 1e-3 --final-gather 0"};
    static const double straight[4] = {1, 0, 0, 0}, turn[4] = {0.9, 0.2, -0.3, 0.25};
    for (int k = 0; k < 2; k++) {
        test_wall("straight", 1, straight, words[k]);
        test_wall("turned", 2, turn, words[k]);
        test_common_floor(straight, words[k]);
    }
}

/* --- pixels --- */

/* A bright square, moved under the pixels by parts of one: of a pixel that an upright or
 * a level edge cuts, each of the nine rays has a ninth to itself, across the edge. */
static void test_edges(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(-1, -1, 0), point(2, 0, 0), point(0, 2, 0), 1);
    paint(&soup, 0.0, 1.0);
    struct solution s = solve_scene(scene_of_soup(&soup), "");
    struct shading *shading = shading_create_flat(s.solver->model.forest);
    struct renderer renderer = renderer_make(s.octree, shading, NULL);
    double worst = 0.0;
    for (int i = 1; i < 50; i++) {
        double moved = 0.01 * i, covered = 1.0 - 2.0 * moved; /* pixels are 0.5 wide */
        struct camera camera = {.eye = point(moved, moved, 4),
                                .at = point(moved, moved, 0),
                                .up = point(0, 1, 0), .fov = 53.13010235415598,
                                .width = 8, .height = 8};
        float *rgb = render_scanlines(&renderer, &camera, 3, 0, 1, NULL);
        worst = fmax(worst, fabs((double)rgb[3 * (4 * 8 + 5)] - covered)); /* upright */
        worst = fmax(worst, fabs((double)rgb[3 * (2 * 8 + 4)] - covered)); /* level */
        alloc_free(rgb);
    }
    tap_ok(worst <= 0.5 / 9.0 + 1e-6, "pixels at edges are off by %.4f at most", worst);
    shading_destroy(shading);
    solution_free(&s);
}

/* Segments that have been fired when half of the picture is done. */
static const struct gather_counts *fired;
static int64_t fired_at_half;

static void look_at_half(struct progress *progress)
{
    if (progress->share <= 0.5)
        fired_at_half = fired->segments;
}

/* The floor in the lower half of a picture, nothing in the upper. Scanlines near the
 * horizon have other work than those below: of 34, two make up a tenth. */
static void test_order(void)
{
    struct solution s = half_shadow(64, 1.0, 0.2);
    struct final_gather *gather = s.solver->beyond->answer->gather;
    struct renderer renderer = renderer_make(s.octree, NULL, gather);
    struct camera camera = {.eye = point(0, -4, 1), .at = point(0, 4, 1),
                            .up = point(0, 0, 1), .fov = 40.0, .width = 8};
    struct progress progress = {.show = look_at_half};
    fired = &gather->counts;
    for (camera.height = 34; camera.height <= 100; camera.height += 33) {
        int64_t before = fired->segments;
        alloc_free(render_scanlines(&renderer, &camera, 1, 0, 1, &progress));
        double share = (double)(fired_at_half - before) /
                       (double)(fired->segments - before);
        tap_ok(fabs(share - 0.5) < 0.1,
               "half of %d scanlines are %.2f of the work", camera.height, share);
    }
    solution_free(&s);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_shadow(false, 64, 0.1);
    test_shadow(false, 4096, 0.025);
    test_shadow(true, 64, 0.1);
    test_noise();
    test_deviation();
    test_specks();
    test_furnace();
    test_strip(0.05, true);
    test_strip(0.3, false);
    test_slot();
    test_gap();
    test_column();
    test_bowl();
    test_smoothed_box();
    test_walls();
    test_edges();
    test_order();
    comm_stop(&world_comm);
    return tap_done();
}
