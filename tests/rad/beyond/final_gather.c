/* Tests of rad/beyond/final_gather.h and rad/beyond/lamps.h: the light of a leaf, by
 * exact factors and by rays, against closed forms. */
#include "mpi/beyond/beyond.h"
#include "mpi/beyond/gather_mesh.h"
#include "rad/beyond/final_gather.h"

#include "geom/lambert.h"
#include "tests/defaults.h"
#include "tests/tap.h"
#include "geom/contour.h"

/* A scene that is solved over its links alone, and a gather over all its leaves. */
struct trial {
    struct solution s;
    struct final_gather gather;
    struct rgb *radiosity; /* by place */
};

static struct trial gather_scene(struct soup *soup, const char *words, int rays)
{
    char all[200];
    snprintf(all, sizeof all, "%s --final-gather 0", words);
    struct trial g = {.s = solve_soup(soup, all)};
    struct forest *forest = g.s.solver->model.forest;
    g.gather = final_gather_create(&g.s.solver->model, rays);
    g.radiosity = alloc_array((size_t)forest->count, sizeof *g.radiosity);
    for (int64_t i = 0; i < forest->count; i++)
        g.radiosity[i] = forest->radiosity[g.gather.order[i]];
    int32_t leaf = forest_next_leaf(forest, -1);
    for (; leaf >= 0; leaf = forest_next_leaf(forest, leaf))
        final_gather_add(&g.gather, leaf, rays, true);
    return g;
}

static void trial_free(struct trial *g)
{
    final_gather_free(&g->gather);
    alloc_free(g->radiosity);
    solution_free(&g->s);
}

static double irradiance(const struct trial *g, int64_t row)
{
    return final_gather_irradiance(&g->gather, row, g->radiosity, true).band[0];
}

/* The mean of H over the leaves of these roots, W/m^2. */
static double mean_of_roots(const struct trial *g, uint32_t first, uint32_t count)
{
    const struct forest *forest = g->s.solver->model.forest;
    double sum = 0.0, area = 0.0;
    for (int64_t i = 0; i < g->gather.count; i++) {
        int32_t leaf = g->gather.rows[i].leaf;
        if (forest->patches[leaf].id.root - first >= count)
            continue;
        sum += forest_area(forest, leaf) * irradiance(g, i);
        area += forest_area(forest, leaf);
    }
    return sum / area;
}

/* --- factors --- */

/* Against the contour integral over both triangles: three points, or as many on quarters
 * of quarters where that is near, have to be right within 0.2 %; out of a gap, where they
 * would find nothing, it is the contour integral itself. */
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
        tap_ok(fabs(off) <= 2e-3, "a wall %g above the floor: factor %.5f, off by %.1e",
               h, exact, off);
    }
    struct triangle beside = {{{1, 0, 0.002}, {0, 1, 0.002}, {1, 1, 0.002}}};
    double exact = triangle_exchange(&floor, &beside) / triangle_area(&floor);
    double off = mean_factor(&floor, plane.normal, &beside, &work) / exact - 1.0;
    tap_ok(fabs(off) <= 1e-9, "light out of a gap of 0.002: factor %.5f, off by %.1e",
           exact, off);
}

/* --- rows --- */

/* Everything shines as it absorbs, so B = H = 1 wherever one looks, behind objects and in
 * gaps; in single precision. */
static void test_furnished(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 2, true);
    paint(&soup, 0.7, 0.3);
    soup_add_box(&soup, point(0.2, 0.2, 0), point(0.5, 0.6, 0.4), 1, false);
    paint(&soup, 0.2, 0.8);
    soup_add_box(&soup, point(0.6, 0.2, 0.001), point(0.9, 0.6, 0.2), 1, false);
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--epsilon 1e-3", 64);
    double worst = 0.0;
    for (int64_t k = 0; k < g.s.solver->model.forest->count; k++)
        g.radiosity[k] = (struct rgb){{1.0, 1.0, 1.0}};
    for (int64_t i = 0; i < g.gather.count; i++)
        if (g.gather.rows[i].bare == 1.0f && g.gather.rows[i].outside == 1.0f)
            worst = fmax(worst, fabs(irradiance(&g, i) - 1.0));
    tap_ok(worst <= 2e-6 && g.gather.counts.escaped == 0,
           "rows of %lld leaves sum to 1, within %.1e", (long long)g.gather.count, worst);
    tap_ok(g.gather.counts.rays > 64 * 60, "by %lld rays",
           (long long)g.gather.counts.rays);
    trial_free(&g);
}

/* Nothing stands between two plates: no rays, and the exact factor, .199825 for unit
 * squares at distance 1 (Howell C-11). Three points on each of eight
 * triangles: 0.05 %. */
static void test_open(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 2);
    paint(&soup, 0.5, 1.0);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 2);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "", 64);
    double h = mean_of_roots(&g, 8, 8), exact = 0.199824895698;
    tap_ok(g.gather.counts.rays == 0 && g.gather.counts.exact == g.gather.count,
           "open plates have exact rows only");
    tap_ok(fabs(h / exact - 1.0) <= 5e-4, "H %.6f, exact %.6f", h, exact);
    trial_free(&g);
}

/* A sheet lies on a bright floor, and nothing stands between them: exact factors are
 * tried, and given up, as the sheet hides their blockers. Rays make the rows, and lamps,
 * which its underside does not face, bring nothing. */
static void test_given_up(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0.4, 0.4, 1e-3), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.4, 0.4, 1), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    paint(&soup, 0.0, 100.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 64);
    const struct forest *forest = g.s.solver->model.forest;
    double lamps = 0.0, rays = 0.0;
    for (int64_t i = 0; i < g.gather.count; i++) {
        const struct gather_row *row = &g.gather.rows[i];
        if (forest->patches[row->leaf].id.root >= 2)
            continue;
        lamps = fmax(lamps, rgb_sum(row->lamps));
        rays = fmax(rays, row->halves[0] + row->chance[0]);
    }
    tap_ok(final_gather_root_is_open(&g.gather, 0, true) && rays > 0.0,
           "exact rows are given up on where a sheet lies");
    tap_ok(lamps == 0.0, "lamps bring nothing to its underside: %g W/m^2", lamps);
    trial_free(&g);
}

/* In a hinge of 30 degrees small leaves at the edge are close to a wide one that does not
 * go on beneath them: factors are exact. Under a sheet that leans on a floor, it does. */
static void test_hinge(double start, bool exact)
{
    struct soup soup = {0};
    double cosine = sqrt(0.75);
    soup_add_quad(&soup, point(0.4, 0, 0), point(0, 1, 0), point(cosine, 0, 0.5), 8);
    paint(&soup, 0.5, 1.0);
    soup_add_quad(&soup, point(start, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 64);
    tap_ok((g.gather.counts.exact == g.gather.count) == exact,
           "%s: %lld of %lld rows are exact", exact ? "a hinge" : "a leaning sheet",
           (long long)g.gather.counts.exact, (long long)g.gather.count);
    trial_free(&g);
}

/* --- lamps --- */

/* A floor below a small lamp, and a black box beside them so that rays are needed.
 * `hidden`: a screen hides half of the lamp from all of the floor, more or less. The
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
    struct scene *scene = g.s.scene;
    *exact = 0.0;
    for (int32_t i = 0; i < 32; i++)
        for (int32_t k = 32; k < 32 + 2 * lamps * lamps; k++)
            *exact += triangle_exchange(&scene->triangles[i], &scene->triangles[k]);
    double area = 0.0;
    for (int32_t i = 0; i < 32; i++)
        area += scene_root_area(scene, i);
    *exact /= area;
    *groups = g.gather.lamps.groups.count;
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
    tap_ok(many < 300, "which are %lld groups", (long long)many);
    h = lit_floor(1, true, &exact, &few);
    tap_ok(fabs(h / exact - 0.5) <= 0.02, "half hidden: %.3f of its light", h / exact);
}

/* A floor sees nothing but a sky of 128 facets around it, of which the horizon cuts some,
 * and a grain of a box that hides less than .1 %. Fewer segments than facets find all of
 * its light, H = E: clusters of facets, chosen by chance, leave 1 %. */
static void test_sky(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(-0.05, -0.05, 0.1), point(0.1, 0, 0), point(0, 0.1, 0), 4);
    paint(&soup, 0.0, 0.0);
    soup_add_sphere(&soup, 1.0, 2);
    for (int64_t i = 32; i < soup.count; i++)
        soup.items[i] = reversed(soup.items[i]);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0.2, 0, 0.2), point(0.201, 0.001, 0.201), 1, false);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "", 64);
    double largest = 0.0, sum = 0.0;
    for (int64_t i = 0; i < g.gather.count; i++) {
        if (g.s.solver->model.forest->patches[g.gather.rows[i].leaf].id.root >= 32)
            continue;
        double off = irradiance(&g, i) - 1.0;
        largest = fmax(largest, fabs(off));
        sum += off / 32.0;
    }
    tap_ok(fabs(sum) < 0.002 && largest < 0.01,
           "below a sky H is E, off by %.2f %% in the mean, %.2f %% at most", 100.0 * sum,
           100.0 * largest);
    trial_free(&g);
}

/* H at a point that looks up, of lamps of E = 1: exact. */
static double lit_by(const struct scene *scene, int32_t first, int32_t end, struct vec3 x)
{
    double h = 0.0;
    for (int32_t k = first; k < end; k++)
        if (plane_distance(&scene->planes[k], x) > 0.0)
            h += point_triangle_factor(x, point(0, 0, 1), &scene->triangles[k]);
    return h;
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
    for (int64_t i = 0; i < g.gather.count; i++) {
        int32_t leaf = g.gather.rows[i].leaf;
        const struct forest *forest = g.s.solver->model.forest;
        if (forest->patches[leaf].id.root >= 32)
            continue;
        struct triangle t = forest_triangle(forest, leaf);
        double h = 0.0;
        for (int k = 0; k < 16; k++) {
            struct triangle quarter = triangle_child(&t, k / 4);
            quarter = triangle_child(&quarter, k % 4);
            h += lit_by(g.s.scene, 32, 288, triangle_centroid(&quarter)) / 16.0;
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

/* A panel of a hundredth of the area of the black floor below it reflects all light that
 * there is: rays are aimed at it. Those in all directions would meet it five times in
 * all. A corner of the box hides .2 %. */
static void test_bright(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 4);
    paint(&soup, 0.0, 0.0);
    soup_add_quad(&soup, point(0.45, 0.45, 1), point(0, 0.1, 0), point(0.1, 0, 0), 1);
    paint(&soup, 0.9, 0.0);
    soup_add_quad(&soup, point(1.1, 0.4, 0), point(0.2, 0, 0), point(0, 0.2, 0), 1);
    paint(&soup, 0.0, 100.0);
    soup_add_box(&soup, point(0, 0, 0.1), point(0.05, 0.05, 0.2), 1, false);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 64);
    const struct triangle *triangles = g.s.scene->triangles;
    double exact = 0.0, area = 0.0;
    for (int64_t k = 0; k < g.s.solver->model.forest->count; k++) {
        uint32_t root = g.s.solver->model.forest->patches[g.gather.order[k]].id.root;
        g.radiosity[k].band[0] = root == 32 || root == 33 ? 1.0 : 0.0;
    }
    for (int32_t i = 0; i < 32; i++) {
        area += triangle_area(&triangles[i]);
        for (int32_t k = 32; k < 34; k++)
            exact += triangle_exchange(&triangles[i], &triangles[k]);
    }
    exact /= area;
    double h = mean_of_roots(&g, 0, 32);
    tap_ok(fabs(h / exact - 1.0) <= 0.01, "a bright panel: %.6f, exact %.6f", h, exact);
    trial_free(&g);
}

/* A white grain of 1 mm lies on a dark floor of 1 m, ten times as bright: it sends a
 * millionth of the light, and no ray is aimed at it. */
static void test_grain(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.09, 0.0);
    soup_add_quad(&soup, point(0.5, 0.5, 1), point(0, 0.1, 0), point(0.1, 0, 0), 1);
    paint(&soup, 0.0, 100.0);
    soup_add_box(&soup, point(0.5, 0.5, 0), point(0.501, 0.501, 0.001), 1, false);
    paint(&soup, 0.9, 0.0);
    struct trial g = gather_scene(&soup, "", 64);
    double bright = lamps_power(&g.gather.bright), lamps = lamps_power(&g.gather.lamps);
    tap_ok(bright == 0.0 && lamps > 0.0, "no ray is aimed at a white grain (%g W)",
           bright);
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
    const struct gather_row *rows = g.gather.rows;
    double worst = 0.0, bright = g.gather.bright.before[72];
    int64_t count = 0;
    for (int64_t i = 0, k = 0; i < g.gather.count; i++) {
        double sum = 0.0;
        bool near = false;
        for (; k < rows[i].end; k++) {
            sum += (double)g.gather.terms[k].weight[0];
            near = near || g.gather.terms[k].near >= 0;
        }
        worst = fmax(worst, near ? 0.0 : fabs(sum - 1.0));
        count += !near;
    }
    tap_ok(bright > 0.0 && worst <= 2e-6 && 4 * count > g.gather.count,
           "beside a bright box rows of %lld leaves sum to 1, within %.1e",
           (long long)count, worst);
    trial_free(&g);
}

/* --- near clusters --- */

/* A sheet 1 mm above a table, under a lamp; neither is divided. The table is bright, but
 * the part in sight of the sheet is dark: only the light that creeps in from the sides,
 * less than a hundredth. */
static void test_gap(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(-2, -2, 0), point(2, 2, 2), 1, true);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(-0.2, -0.2, 2), point(0, 0.4, 0), point(0.4, 0, 0), 1);
    paint(&soup, 0.0, 10.0);
    soup_add_quad(&soup, point(-0.3, -0.2, 0.001), point(0, 0.3, 0), point(0.3, 0, 0), 1);
    soup_add_quad(&soup, point(-0.3, -0.2, 0.001), point(0.3, 0, 0), point(0, 0.3, 0), 1);
    paint(&soup, 0.5, 0.0);
    struct solution s = solve_soup(&soup, "--max-level 0");
    const struct rgb *radiosity = s.solver->model.forest->radiosity;
    double below = radiosity[14].band[0] + radiosity[15].band[0];
    double above = radiosity[16].band[0] + radiosity[17].band[0];
    tap_ok(below < 0.02 * above && above > 0.0,
           "below a sheet on a table: %.5f of the light above it", below / above);
    solution_free(&s);
}

/* Below a small roof over the corner of a wide ground, which is lit from above, a plate
 * stands upright. It sees the shadow, and the ground beyond, instead of the mean of a
 * leaf that is large for it. */
static void test_corner(void)
{
    const struct vec3 u = {0.1, 0, 0}, v = {0, 0.1, 0}, x = {0.93, 0.07, 0.011};
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&soup, point(0.88, 0.02, 0), u, v, 1);
    double factor[2] = {0.0, 0.0};
    for (int i = 0; i < 4; i++)
        factor[i / 2] += point_triangle_factor(x, point(-1, 0, 0), &soup.items[i]);
    soup.count = 2;
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.93, 0.069, 0.01), point(0, 0, 0.002),
                  point(0, 0.002, 0), 1);
    paint(&soup, 0.01, 0.0);
    soup_add_quad(&soup, point(0.88, 0.02, 0.05), u, v, 1);
    soup_add_quad(&soup, point(0.02, 0.88, 0.05), u, v, 1);
    paint(&soup, 0.0, 0.0);
    soup_add_quad(&soup, point(0.2, 0.2, 30), point(0, 0.6, 0), point(0.6, 0, 0), 1);
    paint(&soup, 0.0, 1000.0);
    struct solution s = solve_soup(&soup, "--max-level 0 --final-gather 16384");
    const struct rgb *radiosity = s.solver->model.forest->radiosity;
    double h = 50.0 * (radiosity[2].band[0] + radiosity[3].band[0]);
    double exact = 0.5 * (factor[0] - factor[1]) * 1000.0 * 0.36 / (900.0 * PI);
    tap_ok(fabs(h / exact - 1.0) <= 0.05,
           "below a roof at the corner of a wide ground H = %.5f, %.5f is exact", h,
           exact);
    solution_free(&s);
}

/* A bright box in a box that is a million times as large, in area, and shines: each is a
 * furnace, and solved for, though one has next to all of the light. */
static void test_apart(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0.5, 0.5, 0.5), point(0.501, 0.501, 0.501), 1, true);
    paint(&soup, 0.5, 0.5);
    struct solution s = solve_soup(&soup, "");
    const struct rgb *radiosity = s.solver->model.forest->radiosity;
    double worst = 0.0;
    for (int32_t root = 12; root < 24; root++)
        worst = fmax(worst, fabs(radiosity[root].band[0] - 1.0));
    tap_ok(worst <= 0.005, "a furnace in one a thousand times as wide: off by %.1e",
           worst);
    solution_free(&s);
}

/* The mean B of the walls of a closet that a candle lights, alone or next to a hall. */
static double light_of_closet(bool hall)
{
    struct soup soup = {0};
    double sum = 0.0;
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.5, 0.5, 0.95), point(0, 0.05, 0), point(0.05, 0, 0), 1);
    paint(&soup, 0.5, 10.0);
    if (hall)
        soup_add_box(&soup, point(2, 0, 0), point(4, 2, 2), 1, true);
    paint(&soup, 0.5, 0.0);
    if (hall)
        soup_add_quad(&soup, point(2.5, 0.5, 1.9), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 1e5);
    struct solution s = solve_soup(&soup, "");
    for (int32_t root = 0; root < 12; root++)
        sum += s.solver->model.forest->radiosity[root].band[0] / 12.0;
    solution_free(&s);
    return sum;
}

/* The candle is no lamp next to the hall's light, but it is all the closet has. Coarser
 * leaves are one reason for the difference, noise is the other. */
static void test_candle(void)
{
    double alone = light_of_closet(false), beside = light_of_closet(true);
    tap_ok(fabs(beside / alone - 1.0) <= 0.03,
           "beside a bright hall a closet has B = %.5f, alone %.5f", beside, alone);
}

/* A picture in the plane of a wall, of a quarter of its area. */
static void test_covered(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 8);
    soup_add_quad(&soup, point(0.25, 0.25, 0), point(0.5, 0, 0), point(0, 0.5, 0), 1);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 16);
    double bare = 0.0;
    for (int64_t i = 0; i < 128; i++)
        bare += (double)g.gather.rows[i].bare / 128.0;
    tap_ok(fabs(bare - 0.75) < 1e-6, "of a wall with a picture in it %.3f is bare", bare);
    tap_ok(g.gather.rows[128].bare == 1.0f, "as is all of the picture");
    trial_free(&g);
}

/* Four sides, seen from outside, stand on .04 of a floor below a ceiling. Where they
 * reach it nothing sees that part; where they do not it is the bottom of a bin. The few
 * rays that meet the ceiling inside of the column count as outside: 1 %, of .04. */
static void test_column(double height, double outside)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 4);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 4);
    struct vec3 at = {0.4, 0.4, 0.0}, side = {0.2, 0.0, 0.0}, up = {0.0, 0.0, height};
    for (int k = 0; k < 4; k++) {
        soup_add_quad(&soup, at, side, up, 1);
        at = vec3_add(at, side);
        side = vec3_cross(point(0, 0, 1), side);
    }
    paint(&soup, 0.5, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 256);
    double share = 0.0;
    for (int64_t i = 0; i < 32; i++)
        share += (double)g.gather.rows[i].outside / 32.0;
    tap_ok(fabs(share - outside) < 0.002,
           "a column of height %g stands on a floor: %.4f of it is outside", height,
           share);
    trial_free(&g);
}

/* H at the middle of the last root, without that straight from lamps; `open`: of
 * final_gather_set_partly_covered(), or NULL. */
static double rest_at_last(struct trial *g, const uint8_t *open, int rays)
{
    const struct scene *scene = g->s.scene;
    int32_t last = scene_root_count(scene) - 1;
    struct triangle t = scene_root_triangle(scene, last);
    struct vec3 x = triangle_centroid(&t);
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = scene_root_plane(scene, last),
                                   .input = scene_input_of(scene, last)};
    if (open)
        final_gather_set_partly_covered(&g->gather, open);
    return final_gather_at(&g->gather, &points, 1, rays, true).rest.band[0];
}

/* A wide lamp behind a window of a metre in a wall of four pieces, as a point of a floor
 * sees it in a pixel: all of the window shines. Of segments to all of the lamp one in
 * twenty or fewer passes the window; 32 of them are off by a half. What walls hide is cut
 * out, exactly; of a piece that none of 32 segments meets no more than a 32nd of the
 * remainder is left, more or less, of two no more than .07. Without a sill the window
 * goes on below the floor: no segment is cast to points there. */
static void test_window(bool sill)
{
    enum { RUNS = 8, SEGMENTS = 32 };
    const int walls = sill ? 4 : 3, input = 2 * walls;
    struct soup soup = {0};
    struct vec3 y = point(0, 1, 0), z = point(0, 0, 1);
    const struct vec3 low = point(4, 1.5, sill ? 1 : -2), high = point(4, 1.5, 2),
                      floor = point(1.5, 1.6, 0);
    const double foot = sill ? 0 : -3;
    const double pieces[4][4] = {
        {-20, 1.5, foot, 20}, {2.5, 20, foot, 20}, {1.5, 2.5, 2, 20}, {1.5, 2.5, 0, 1}};
    for (int k = 0; k < walls; k++)
        soup_add_quad(&soup, point(4, pieces[k][0], pieces[k][2]),
                      vec3_scale(z, pieces[k][3] - pieces[k][2]),
                      vec3_scale(y, pieces[k][1] - pieces[k][0]), 1);
    soup_add_quad(&soup, point(0, 0, 0), point(4, 0, 0), point(0, 4, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(9, -20, -6), vec3_scale(z, 36), vec3_scale(y, 45), 1);
    paint(&soup, 0.0, 1.0);
    struct trial g = gather_scene(&soup, "--max-level 0", 1);
    const struct vec3 window[4] = {low, high, vec3_add(high, y), vec3_add(low, y)};
    struct vec3 x = scene_from_input(g.s.scene, floor);
    struct gather_points points = {.at = &x, .count = 1, .middle = x,
                                   .plane = scene_root_plane(g.s.scene, input),
                                   .input = scene_input_of(g.s.scene, input)};
    double exact = point_polygon_factor(floor, z, window, 4), worst = 0.0;
    for (uint64_t run = 0; run < RUNS; run++) {
        struct rgb h =
            final_gather_at(&g.gather, &points, run, SEGMENTS, false).lamps;
        worst = fmax(worst, fabs(h.band[0] / exact - 1.0));
    }
    tap_ok(worst <= 0.07, "a lamp behind a window: %.4f is exact, off by %.2g at most",
           exact, worst);
    trial_free(&g);
}

/* A ceiling is lit by the floor, and that by a lamp of 32 facets which faces it, but not
 * the ceiling. Paths that go on from the floor, as if things stood on it, find the lamp:
 * as much light as by the means of its leaves, but for the noise of 1,024 rays. */
static void test_lamp_that_faces_away(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 4);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(0.4, 0.4, 0.5), point(0, 0.2, 0), point(0.2, 0, 0), 4);
    paint(&soup, 0.0, 100.0);
    soup_add_quad(&soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 0.0);
    struct trial g = gather_scene(&soup, "", 16);
    uint8_t *open = alloc_array((size_t)g.gather.count, sizeof *open);
    double means = rest_at_last(&g, NULL, 1024), points = rest_at_last(&g, open, 1024);
    tap_ok(means > 0.1 && fabs(points / means - 1.0) <= 0.05,
           "by points of a floor a ceiling has H = %.3f, by means of leaves %.3f", points,
           means);
    alloc_free(open);
    trial_free(&g);
}

/* H in a furnace of B = 1 in which the first two roots, one side, are dark as if
 * covered. */
static double beside_dark_side(struct trial *g, const uint8_t *open)
{
    struct forest *forest = g->s.solver->model.forest;
    for (int64_t p = 0; p < forest->count; p++) {
        double b = forest->patches[p].id.root < 2 ? 0.0 : 1.0;
        forest->radiosity[p] = (struct rgb){{b, b, b}};
    }
    return rest_at_last(g, open, 64);
}

/* Of a leaf that a thing stands on, a point sees the bright part; paths that meet it
 * again go on by chance. */
static void test_covered_for_points(void)
{
    static const uint8_t OPEN[12] = {0, 15, 16, 16, 16, 16, 16, 16, 16, 16, 16, 16};
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&soup, 0.5, 0.5);
    struct trial g = gather_scene(&soup, "--max-level 0", 16);
    double dark = beside_dark_side(&g, NULL), covered = beside_dark_side(&g, OPEN);
    tap_ok(dark < 0.9, "beside a dark side a point has H = %.3f", dark);
    tap_ok(fabs(covered - 1.0) <= 0.05, "beside a covered one it has %.3f", covered);
    trial_free(&g);
}

/* A lamp in the plane of the ceiling that comes before it in the file: rays meet the
 * ceiling, segments reach the lamp, and the room is as bright as with the lamp behind. */
static void test_flush_lamp(void)
{
    double mean[2];
    for (int first = 0; first < 2; first++) {
        struct soup soup = {0};
        for (int part = 0; part < 2; part++)
            if (part == first) {
                soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, true);
                soup_add_box(&soup, point(0.6, 0.6, 0), point(0.8, 0.8, 0.5), 1, false);
                paint(&soup, 0.5, 0.0);
            } else {
                soup_add_quad(&soup, point(0.4, 0.4, 1), point(0, 0.2, 0),
                              point(0.2, 0, 0), 1);
                paint(&soup, 0.0, 10.0);
            }
        struct solution s = solve_soup(&soup, "");
        int32_t floor = (first == 0 ? 0 : 2) + 8; /* z = 0 */
        mean[first] = s.solver->model.forest->radiosity[floor].band[0];
        solution_free(&s);
    }
    tap_ok(mean[0] > 0.0 && fabs(mean[1] / mean[0] - 1.0) < 0.05,
           "a lamp before its ceiling in the file: %.4f, behind it: %.4f", mean[1],
           mean[0]);
}

/* --- the mesh --- */

/* H of a lamp at points, per E: one of the first 2 roots after `floor` roots. */
static double lit(const struct scene *scene, struct vec3 x, int32_t floor)
{
    struct vec3 up = {0.0, 0.0, 1.0};
    return point_triangle_factor(x, up, &scene->triangles[floor]) +
           point_triangle_factor(x, up, &scene->triangles[floor + 1]);
}

/* A floor below a small lamp, and a small black box because of which rays are needed; the
 * links split nothing. Leaves are to be split until A times the variance of their light
 * over quarters is at most 0.005 epsilon of the sum of A B^2 (MESH in gather_mesh.c),
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
    const struct gathered *gathered = &s.solver->beyond->answer.counts;
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
                h[k] = 0.0;
                for (int q = 0; q < 4; q++) {
                    struct triangle quarter = triangle_child(&child, q);
                    h[k] += 0.25 * lit(forest->scene, triangle_centroid(&quarter), 2);
                }
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
    double rays = (double)gathered->rays / (double)forest_count(forest).leaves;
    tap_ok(rays > 180.0 && rays <= 256.0, "%.0f rays for each leaf in the mean", rays);
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
    double closing = s.solver->beyond->answer.counts.closing;
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
    tap_ok(s.solver->beyond->answer.counts.split == 0 &&
               s.solver->beyond->answer.counts.looks > 0,
           "in a furnace nothing is split, by %lld rays",
           (long long)s.solver->beyond->answer.counts.looks);
    solution_free(&s);
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
 * light is as good as even, but whether a ray finds any is chance. Looks tell that: the
 * variance of a leaf's quarters is above its expectation for one leaf in four, which may
 * be split; otherwise all are, and again. Leaves of the cube get the most rays that there
 * are, 16 times the mean, and black ones the least, with a quarter more aimed at the
 * cube. */
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
    const struct gathered *gathered = &s.solver->beyond->answer.counts;
    int64_t cube = s.stats.leaves - WALLS;
    tap_ok(4 * gathered->split <= CUBE && cube == CUBE + 3 * gathered->split,
           "of 12 leaves whose light varies by chance alone %lld are split",
           (long long)gathered->split);
    int64_t rays = cube * 16 * MEAN + WALLS * MEAN / 4;
    tap_ok(gathered->rays >= rays && gathered->rays <= rays + WALLS * MEAN / 16,
           "%lld rays for %lld noisy leaves and 1200 black ones",
           (long long)gathered->rays, (long long)cube);
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
    struct final_gather gather = final_gather_create(model, RAYS);
    double spread = 0.0, noise = 0.0, alone = 0.0;
    for (int32_t p = 0; p < model->forest->count; p++) {
        const struct patch *patch = &model->forest->patches[p];
        if (!patch_is_leaf(patch) || patch->id.root < WALLS)
            continue;
        struct gather_look look = final_gather_look(&gather, p, RAYS);
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
    final_gather_free(&gather);
    solution_free(&s);
}

/* With few rays there are no looks. Of three squares of a size, grey, white, and white
 * below a lamp, the first reflects a quarter of the noise that the second does, and the
 * third is brighter than the mean. (One of two boxes hides the other: rows by rays.) */
static void test_guess(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.2, 0.0);
    soup_add_quad(&soup, point(0, 3, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&soup, point(0, 6, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.8, 0.0);
    soup_add_quad(&soup, point(0, 6, 0.1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.0, 1.0);
    soup_add_box(&soup, point(0, 2.5, 1), point(1, 4.5, 2), 1, false);
    soup_add_box(&soup, point(0, 2.5, 3), point(1, 4.5, 4), 1, false);
    paint(&soup, 0.0, 0.0);
    struct solution s = solve_soup(&soup, "--max-level 0 --final-gather 16");
    struct gather_mesh mesh = {.count = 0};
    bool made = gather_mesh_make(s.solver, 0, &mesh);
    const int *rays = mesh.rays;
    tap_ok(made && mesh.traced == 0 && 2 * rays[0] <= rays[2] && 2 * rays[2] <= rays[4],
           "%d rays for a grey leaf, %d for a white one, %d below a lamp", rays[0],
           rays[2], rays[4]);
    gather_mesh_free(&mesh);
    solution_free(&s);
}

int main(int argc, char **argv)
{
    comm_start(&world_comm, &argc, &argv);
    test_mean_factor();
    test_furnished();
    test_open();
    test_given_up();
    test_hinge(0.4, true);
    test_hinge(0.0, false);
    test_lamps();
    test_sky();
    test_bulbs();
    test_bright();
    test_bright_rows();
    test_grain();
    test_gap();
    test_corner();
    test_apart();
    test_candle();
    test_covered();
    test_column(1.0, 0.96);
    test_column(0.9, 1.0);
    test_covered_for_points();
    test_window(true);
    test_window(false);
    test_lamp_that_faces_away();
    test_flush_lamp();
    test_mesh(0.1);
    test_mesh(0.02);
    test_near();
    test_even();
    test_chance();
    test_looks();
    test_guess();
    comm_stop(&world_comm);
    return tap_done();
}
