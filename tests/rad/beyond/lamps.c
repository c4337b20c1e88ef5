/* Tests of senders and cuts (rad/beyond/gather/), and of aiming at lamps and bright
 * patches: the light of these at leaves and points, against closed forms. */
#include "geom/contour.h"
#include "rad/beyond/gather/factor.h"
#include "tests/gathered.h"
#include "tests/tap.h"

/* Against the contour integral over both triangles: three points, or as many on quarters
 * of quarters where that is near, have to be right within 0.25 %; out of a gap, where
 * they would find nothing, it is the contour integral itself. */
static void test_mean_factor(void)
{
    static const double heights[] = {0.0, 0.1, 1.0, 3.0};
    const struct triangle floor = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    struct plane plane = triangle_plane(&floor);
    int64_t work = 0;
    for (int k = 0; k < 4; k++) {
        double h = heights[k];
        struct triangle wall = {{{0, 0, h}, {0, 1, h}, {0, 0, 1 + h}}};
        double exact = triangle_exchange(&floor, &wall) / triangle_area(&floor);
        double off = mean_factor(&floor, plane.normal, &wall, &work) / exact - 1.0;
        tap_ok(fabs(off) <= 2.5e-3, "a wall %g above the floor: factor %.5f, off by %.1e",
               h, exact, off);
    }
    struct triangle beside = {{{1, 0, 0.002}, {0, 1, 0.002}, {1, 1, 0.002}}};
    double exact = triangle_exchange(&floor, &beside) / triangle_area(&floor);
    double off = mean_factor(&floor, plane.normal, &beside, &work) / exact - 1.0;
    tap_ok(fabs(off) <= 1e-9, "light out of a gap of 0.002: factor %.5f, off by %.1e",
           exact, off);
}

/* The factor from the first 32 roots, a floor, to those up to `end`. */
static double factor_of_floor(const struct scene *scene, int32_t end)
{
    double exchange = 0.0, area = 0.0;
    for (int32_t i = 0; i < 32; i++) {
        area += triangle_area(&scene->triangles[i]);
        for (int32_t k = 32; k < end; k++)
            exchange += triangle_exchange(&scene->triangles[i], &scene->triangles[k]);
    }
    return exchange / area;
}

/* A floor below a small lamp, and a black box beside them so that rays are needed.
 * `screened`: a screen hides half of the lamp from all of the floor, more or less. The
 * lamp's direct light is all there is: the floor is black. */
static double lit_floor(int lamps, bool screened, double *exact, int64_t *groups)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 4);
    paint(&soup, 0.0, 0.0);
    soup_add_quad(&soup, point(0.45, 0.45, 1), point(0, 0.1, 0), point(0.1, 0, 0), lamps);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0, 0, 0.1), point(0.05, 0.05, 0.2), 1, false);
    if (screened) /* right below the lamp, upwards and downwards */
        soup_add_box(&soup, point(0.44, 0.44, 0.998), point(0.5, 0.56, 0.999), 1, false);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "", 64);
    *exact = factor_of_floor(g.s.scene, 32 + 2 * lamps * lamps);
    *groups = cuts_at(g.gather->aims->cuts[LAMPS], g.gather->rows[0].leaf).count;
    double mean = mean_of_roots(&g, 0, 32);
    trial_free(&g);
    return mean;
}

/* Where nothing hides the lamp its light is that of exact factors, but for that which
 * the corner of the box takes (its share of the hemisphere below the lamp, .2 % at
 * most). Lamps of a group are chosen by chance: 1 %. */
static void test_lamps(void)
{
    double exact;
    int64_t few, many;
    double h = lit_floor(1, false, &exact, &few);
    tap_ok(h <= 1.001 * exact && h >= 0.997 * exact,
           "a lamp of 2 triangles: %.6f, exact %.6f", h, exact);
    h = lit_floor(24, false, &exact, &many);
    tap_ok(fabs(h / exact - 1.0) <= 0.01, "of 1152 triangles: %.6f, exact %.6f", h,
           exact);
    tap_ok(many < 300, "which are %lld nodes of a cut", (long long)many);
    h = lit_floor(1, true, &exact, &few);
    tap_ok(fabs(h / exact - 0.5) <= 0.02, "half hidden: %.3f of its light", h / exact);
}

/* Two bulbs of 128 facets above a floor, one of them higher, each of which is a cluster
 * that many segments are aimed at: it is opened, until parts get one each of the 64,
 * which is 1.6 % of the light. With facets chosen by chance from all around the bulb,
 * leaves were off by 4.4 %, 23 % at most. */
static void test_bulbs(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(-1, -1, 0), point(2, 0, 0), point(0, 2, 0), 4);
    paint(&soup, 0.0, 0.0);
    soup_add_sphere(&soup, 0.1, 2);
    soup_add_sphere(&soup, 0.1, 2);
    for (int64_t i = 32; i < soup.count; i++)
        for (int k = 0; k < 3; k++)
            soup.items[i].corner[k] =
                vec3_add(soup.items[i].corner[k],
                         i < 160 ? point(0.4, 0.3, 1) : point(-0.5, 0, 2));
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0.2, 0, 0.2), point(0.201, 0.001, 0.201), 1, false);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "", 64);
    double largest = 0.0, squares = 0.0;
    for (int64_t i = 0; i < g.gather->count; i++) {
        int32_t leaf = g.gather->rows[i].leaf;
        const struct forest *forest = g.s.solver->model.forest;
        if (forest->patches[leaf].id.root >= 32)
            continue;
        struct triangle t = forest_triangle(forest, leaf);
        double h = 0.0;
        for (int k = 0; k < 4; k++) {
            struct triangle quarter = triangle_child(&t, k);
            h += 0.25 * lit_by(g.s.scene, 32, 288, &quarter);
        }
        double off = irradiance(&g, i) / h - 1.0;
        largest = fmax(largest, fabs(off));
        squares += off * off / 32.0;
    }
    tap_ok(largest < 0.06 && squares < 0.016 * 0.016,
           "below bulbs of 256 facets leaves are off by %.2f %%, at most %.2f %%",
           100.0 * sqrt(squares), 100.0 * largest);
    trial_free(&g);
}

/* A candle just below the ceiling, of one quad, lights a spot of it, which is all the
 * light of the floor: rays are aimed at it. One ray in fifty finds it by chance, and
 * leaves would be off by 61 %, not 7; of a small spot, which makes the mean of the
 * ceiling bright, by 183 % if rays aimed at all of that, not 6. A tube along a side of
 * the room lights a strip, which no quarter of the ceiling has for itself: 17 %, not 13,
 * and as much if a quarter of the rays aimed at it. Each leaf against exact factors; in
 * the mean they are off by 1, 0 and -5 %. */
static void test_bright_part(struct vec3 at, double length, const char *words)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 4);
    paint(&soup, 0.0, 0.0);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.9, 0.0);
    soup_add_quad(&soup, at, point(0.004, 0, 0), point(0, length, 0), 1);
    paint(&soup, 0.0, 40.0 / length);
    soup_add_box(&soup, point(0, 0, 0.1), point(0.05, 0.05, 0.2), 1, false);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, words, 64);
    const struct forest *forest = g.s.solver->model.forest;
    double squares = 0.0, mean = 0.0, count = 0.0;
    int64_t work = 0;
    for (int64_t i = 0; i < g.gather->count; i++) {
        int32_t leaf = g.gather->rows[i].leaf, from = forest_next_leaf(forest, -1);
        struct triangle to = forest_triangle(forest, leaf);
        double exact = 0.0;
        for (; from >= 0; from = forest_next_leaf(forest, from))
            if (forest->patches[from].id.root - 32 < 2) {
                struct triangle sender = forest_triangle(forest, from);
                exact += forest->radiosity[from].band[0] *
                         mean_factor(&to, point(0, 0, 1), &sender, &work);
            }
        if (forest->patches[leaf].id.root >= 32)
            continue;
        double off = irradiance(&g, i) / exact - 1.0;
        squares += off * off;
        mean += off;
        count++;
    }
    double rms = sqrt(squares / count);
    mean /= count;
    tap_ok(rms <= 0.15 && fabs(mean) <= 0.06,
           "above a lamp of %g at %g a bright ceiling: RMS of %g leaves %g, mean %+g",
           length, at.z, count, rms, mean);
    trial_free(&g);
}

/* H of a pixel at a point of a root, by reflected light alone: its noise is less than .1,
 * and its mean that of more rays, within four of its deviations. */
static void judge_pixel(struct trial *g, int32_t root, struct vec3 weights,
                        const char *name)
{
    enum { RUNS = 200, RAYS = 256, MORE = 65536 };
    struct triangle t = scene_root_triangle(g->s.scene, root);
    struct vec3 x = corners_mean(t.corner, weights);
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = scene_root_plane(g->s.scene, root),
                                   .root = root};
    double truth = final_gather_at(g->gather, &points, RUNS, MORE, true).rest.band[0];
    double mean = 0.0, squares = 0.0, most = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        double h = final_gather_at(g->gather, &points, run, RAYS, true).rest.band[0];
        mean += h / RUNS;
        squares += h * h / RUNS;
        most = fmax(most, h);
    }
    double noise = sqrt(squares / (mean * mean) - 1.0);
    tap_ok(noise < 0.1 && most < 1.5 * truth && fabs(mean / truth - 1.0) < 0.02,
           "a pixel %s: H = %.4f, by more rays %.4f, %.4f at most", name, mean, truth,
           most);
}

/* The pixel of the floor is beside a wall, which is too near for its leaf's mean: paths
 * go on from there, and of their rays, too, few meet the spot above the candle. Found by
 * chance alone it makes single pixels four times too bright, and noise of 54 %, not 6. */
static void test_bright_beside(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&soup, point(0, 0, 0), point(0, 1, 0), point(0, 0, 1), 1);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.9, 0.0);
    soup_add_quad(&soup, point(0.4, 0.6, 0.97), point(0.004, 0, 0), point(0, 0.004, 0),
                  1);
    paint(&soup, 0.0, 1e4);
    struct trial g = gather_scene(&soup, "--epsilon 1e-3", 64);
    judge_pixel(&g, 1, point(0.5, 0.003, 0.497), "beside a wall");
    trial_free(&g);
}

/* A bulb in its holder, in a room. The holder is hundreds of times as bright as the
 * walls, and sends less than a hundredth of their light. Found by chance it is a
 * speck. */
static void test_holder(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.7, 0.0);
    soup_add_box(&soup, point(0.49, 0.49, 0.50), point(0.51, 0.51, 0.52), 1, false);
    paint(&soup, 0.0, 1e4);
    soup_add_box(&soup, point(0.48, 0.48, 0.48), point(0.52, 0.52, 0.50), 1, false);
    paint(&soup, 0.1, 0.0);
    struct trial g = gather_scene(&soup, "--epsilon 1e-3", 64);
    judge_pixel(&g, 10, point(0.3, 0.3, 0.4), "below a bulb in its holder");
    trial_free(&g);
}

/* Eighty bulbs of 32 facets on a wall: one is chosen by the cut of the leaf's region for
 * a point beside one of them. Its light is right in the mean. */
static void test_choice(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 0.0);
    for (int bulb = 0; bulb < 80; bulb++) {
        soup_add_sphere(&soup, 0.01, 1);
        for (int64_t i = soup.count - 32; i < soup.count; i++)
            for (int k = 0; k < 3; k++)
                soup.items[i].corner[k] =
                    vec3_add(soup.items[i].corner[k],
                             point(0.1 * (bulb % 10) + 0.05, 0.1 * (bulb / 10) + 0.05,
                                   0.03));
    }
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--epsilon 1e-2", 16);
    const struct scene *scene = g.s.scene;
    struct vec3 up = scene_root_plane(scene, 0).normal;
    struct vec3 x = scene_from_input(scene, point(0.37, 0.44, 0.0));
    double exact = 0.0, mean = 0.0;
    for (int32_t root = 2; root < scene_root_count(scene); root++) {
        struct triangle t = scene_root_triangle(scene, root);
        exact += point_triangle_factor(x, up, &t);
    }
    enum { CHOICES = 1 << 16 };
    struct cuts *cuts = g.gather->aims->cuts[LAMPS];
    struct cut cut = cuts_at(cuts, g.gather->rows[0].leaf);
    for (int k = 0; k < CHOICES; k++) {
        struct choice lamp = cuts_choose(cuts, cut, (k + 0.5) / CHOICES);
        struct triangle t = scene_root_triangle(scene, lamp.patch);
        mean += lamp.share * point_triangle_factor(x, up, &t) / CHOICES;
    }
    tap_ok(fabs(mean / exact - 1.0) < 0.01,
           "one of 2560 lamps is chosen: %.6f in the mean, %.6f is exact", mean, exact);
    trial_free(&g);
}

/* In a closed room with a box lit brightly by a lamp beside it, rows still sum to 1, but
 * those of which a ray has gone on. */
static void test_bright_rows(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 2, true);
    paint(&soup, 0.5, 0.0);
    soup_add_box(&soup, point(0.5, 0.5, 0.5), point(0.55, 0.55, 0.55), 1, false);
    paint(&soup, 0.9, 0.0);
    soup_add_box(&soup, point(0.6, 0.5, 0.5), point(0.65, 0.55, 0.55), 1, false);
    paint(&soup, 0.0, 100.0);
    struct trial g = gather_scene(&soup, "", 64);
    const struct gather_row *rows = g.gather->rows;
    double worst = 0.0, bright = senders_power(g.gather->aims->senders[BRIGHT_PATCHES]);
    int64_t count = 0;
    for (int64_t i = 0, k = 0; i < g.gather->count; i++) {
        double sum = 0.0;
        bool near = false;
        for (; k < rows[i].end; k++) {
            sum += (double)g.gather->terms[k].weight[0];
            near = near || g.gather->terms[k].near >= 0;
        }
        worst = fmax(worst, near ? 0.0 : fabs(sum - 1.0));
        count += !near;
    }
    tap_ok(bright > 0.0 && worst <= 2e-6 && 4 * count > g.gather->count,
           "beside a bright box rows of %lld leaves sum to 1, within %.1e",
           (long long)count, worst);
    trial_free(&g);
}

/* A wall at x = 4 from z = `foot` on, in pieces around a window of a metre: the fourth is
 * its sill. */
static void add_wall_with_window(struct soup *soup, int pieces, double foot)
{
    const double edges[4][4] = {
        {-20, 1.5, foot, 20}, {2.5, 20, foot, 20}, {1.5, 2.5, 2, 20}, {1.5, 2.5, 0, 1}};
    for (int k = 0; k < pieces; k++)
        soup_add_quad(soup, point(4, edges[k][0], edges[k][2]),
                      point(0, 0, edges[k][3] - edges[k][2]),
                      point(0, edges[k][1] - edges[k][0], 0), 1);
}

/* A wide lamp behind a window of a metre in a wall of four pieces, as a point of a floor
 * sees it in a pixel: all of the window shines. Of segments to all of the lamp one in
 * twenty or fewer passes the window, so single pixels are noisy; they are right in the
 * mean, within three of its standard errors. Without a sill the window goes on below the
 * floor: no segment is cast to points there. */
static void test_window(bool sill)
{
    enum { RUNS = 1024, SEGMENTS = 32 };
    const int walls = sill ? 4 : 3, input = 2 * walls;
    struct soup soup = {0};
    struct vec3 y = point(0, 1, 0), z = point(0, 0, 1);
    const struct vec3 low = point(4, 1.5, sill ? 1 : -2), high = point(4, 1.5, 2),
                      floor = point(1.5, 1.6, 0);
    const double foot = sill ? 0 : -3;
    add_wall_with_window(&soup, walls, foot);
    soup_add_quad(&soup, point(0, 0, 0), point(4, 0, 0), point(0, 4, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(9, -20, -6), vec3_scale(z, 36), vec3_scale(y, 45), 1);
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 1);
    const struct vec3 window[4] = {low, high, vec3_add(high, y), vec3_add(low, y)};
    struct vec3 x = scene_from_input(g.s.scene, floor);
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = scene_root_plane(g.s.scene, input),
                                   .root = input};
    double exact = point_polygon_factor(floor, z, window, 4), sum = 0.0, squares = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct rgb h =
            final_gather_at(g.gather, &points, run, SEGMENTS, false).straight;
        double off = h.band[0] / exact - 1.0;
        sum += off / RUNS;
        squares += off * off / RUNS;
    }
    double error = sqrt((squares - sum * sum) / RUNS);
    tap_ok(fabs(sum) <= 3.0 * error && error < 0.1,
           "a lamp behind a window: %.4f is exact, off by %+.3f in the mean of %d, "
           "+- %.3f",
           exact, sum, RUNS, error);
    trial_free(&g);
}

/* H of some points together by segments to lamps. */
static double sum_of_runs(struct trial *g, const struct gather_points *points,
                          int segments)
{
    double sum = 0.0;
    for (uint64_t run = 0; run < 32; run++)
        sum += final_gather_at(g->gather, points, run, segments, false).straight.band[0];
    return sum;
}

/* The same window before a sky of many small lamps: 32 segments are dealt by the shares
 * that the leaf around sees, which leave .7 RMS, and so .06 in the mean of 128. No pixel
 * claims to be sure that has found nothing. */
static void test_sky_behind_window(void)
{
    enum { RUNS = 128, SEGMENTS = 32 };
    struct soup soup = {0};
    const struct vec3 y = point(0, 1, 0), z = point(0, 0, 1), floor = point(1.5, 1.6, 0);
    add_wall_with_window(&soup, 4, 0.0);
    soup_add_quad(&soup, point(1, 1, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(9, -20, -6), vec3_scale(z, 36), vec3_scale(y, 45), 16);
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 1);
    const struct vec3 window[4] = {point(4, 1.5, 1), point(4, 1.5, 2), point(4, 2.5, 2),
                                   point(4, 2.5, 1)};
    struct vec3 x = scene_from_input(g.s.scene, floor);
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = scene_root_plane(g.s.scene, 8), .root = 8};
    double exact = point_polygon_factor(floor, z, window, 4), sum = 0.0, square = 0.0;
    double claimed = HUGE_VAL;
    double first = sum_of_runs(&g, &points, SEGMENTS);
    final_gather_forget(g.gather);
    sum_of_runs(&g, &points, 4 * SEGMENTS);
    tap_ok(first == sum_of_runs(&g, &points, SEGMENTS),
           "the lamps that a leaf sees are the same whoever asks first");
    for (uint64_t run = 0; run < RUNS; run++) {
        struct gather_light light =
            final_gather_at(g.gather, &points, run, SEGMENTS, false);
        double off = light.straight.band[0] / exact - 1.0;
        sum += off / RUNS;
        square += off * off / RUNS;
        claimed = fmin(claimed, sqrt(rgb_sum(light.variance) / BANDS) / exact);
    }
    tap_ok(fabs(sum) <= 0.19 && sqrt(square) <= 0.9 && claimed >= 0.4,
           "a sky behind a window: off by %+.2f in the mean, %.2f RMS, %.2f is claimed "
           "at least", sum, sqrt(square), claimed);
    trial_free(&g);
}

/* Segments counted at the nodes of the lamp of roots `first` and the next. */
struct counted {
    double asked, arrived, found;
};

static struct counted count_lamp(const struct cuts *cuts, struct cut cut, int32_t first)
{
    struct counted counted = {0.0, 0.0, 0.0};
    for (int64_t i = cut.first; i < cut.first + cut.count; i++) {
        const struct cut_node *node = &cuts->nodes[i];
        int32_t lamp = cuts->senders->patches[cuts->senders->nodes[node->node].first];
        if (lamp / 2 != first / 2)
            continue;
        counted.asked += (double)node->asked;
        counted.arrived += (double)node->arrived;
        counted.found = cut_found(&cut, node, 1.0);
    }
    return counted;
}

/* Looks at a floor below four lamps: one is seen, one hidden, one half hidden (within
 * .05, by the edge of its screen and by chance); of the last the segments are not told,
 * so its share is the mean of all. Before anything is learnt shares are a half. */
static void test_shares(void)
{
    enum { RAYS = 64 };
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 0.0);
    for (int k = 0; k < 4; k++)
        soup_add_quad(&soup, point(k % 2 ? 0.8 : 0.1, k / 2 ? 0.8 : 0.1, 1),
                      point(0, 0.1, 0), point(0.1, 0, 0), 1);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0.79, 0.09, 0.998), point(0.91, 0.21, 0.999), 1, false);
    soup_add_box(&soup, point(0.09, 0.79, 0.998), point(0.15, 0.91, 0.999), 1, false);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "--max-level 0", RAYS);
    struct cuts *cuts = g.gather->aims->cuts[LAMPS];
    cuts_count(cuts);
    struct cut cut = cuts_at(cuts, 0);
    double before = count_lamp(cuts, cut, 2).found;
    for (int32_t leaf = 0; leaf < 2; leaf++)
        final_gather_look(g.gather, leaf, RAYS);
    for (int64_t i = cut.first; i < cut.first + cut.count; i++)
        if (cuts->senders->patches[cuts->senders->nodes[cuts->nodes[i].node].first] >= 8)
            cuts->tally[2 * i] = cuts->tally[2 * i + 1] = 0;
    cuts_learn(cuts);
    cut = cuts_at(cuts, 0);
    struct counted seen = count_lamp(cuts, cut, 2), hidden = count_lamp(cuts, cut, 4);
    struct counted half = count_lamp(cuts, cut, 6), none = count_lamp(cuts, cut, 8);
    double part = half.arrived / half.asked;
    double mean = (seen.arrived + hidden.arrived + half.arrived + 0.5) /
                  (seen.asked + hidden.asked + half.asked + 1.0);
    tap_ok(before == 0.5 && cuts_at(cuts, 1).first == cut.first &&
               seen.asked + hidden.asked + half.asked > 4 * RAYS,
           "shares begin with %g; %g, %g and %g segments of looks at two leaves", before,
           seen.asked, hidden.asked, half.asked);
    tap_ok(seen.arrived == seen.asked && hidden.arrived == 0.0 && fabs(part - 0.5) < 0.05,
           "seen: %g arrive, hidden: %g, half hidden: a part of %.3f", seen.arrived,
           hidden.arrived, part);
    tap_ok(none.asked == 0.0 && fabs(none.found - mean) < 0.05,
           "a lamp without a segment has the share %.3f, the mean is %.3f", none.found,
           mean);
    trial_free(&g);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_mean_factor();
    test_lamps();
    test_bulbs();
    test_bright_beside();
    test_holder();
    test_choice();
    test_shares();
    test_bright_part(point(0.4, 0.6, 0.9), 0.004, "--max-level 6");
    test_bright_part(point(0.4, 0.6, 0.97), 0.004, "--max-level 7");
    test_bright_part(point(0.01, 0, 0.98), 1.0, "--max-level 7");
    test_bright_rows();
    test_window(true);
    test_window(false);
    test_sky_behind_window();
    comm_stop(&world_comm);
    return tap_done();
}
