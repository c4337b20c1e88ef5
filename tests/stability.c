/* What breaks radiosity programs: one test for each entry of a checklist, but for those that other
 * tests cover:
 *
 *     F <= 1, G <= the smaller area      here, after refinement; formfactor.c, contour.c
 *     singular shared edges              contour.c, 55-validate.sh
 *     closure drift, rho to 0.999        furnace.c
 *     false convergence                  here; exact.c
 *     rho >= 1, negative, NaN, huge Ke   75-materials.sh, scene.c
 *     light leaks                        here
 *     coplanar overlap, duplicates       here
 *     covered patches, interpenetration  here
 *     slivers                            furnace.c
 *     faces without area                 here; scene.c counts them
 *     scale                              here, fixed mesh; 65-invariance.sh, 2^k to the bit
 *     offset                             here, fixed mesh; 65-invariance.sh
 *     scale of the emission              here
 *     a tiny bright light                here
 *     16 levels                          options.c refuses them; 15 here
 *     oscillation, termination           here
 *     rays through edges and corners     octree.c, bundles.c
 *     T-vertices                         here, the picture; shading.c, continuity
 *     partial visibility                 here
 *     flipped faces                      here
 *     open scenes                        here; exact.c, the links' own sum
 *     order of faces and corners         here
 *     linearity, reciprocity             here
 *
 * All with phr's defaults but for what a test says. */
#include "geom/contour.h"
#include "io/camera.h"
#include "io/render.h"
#include "tests/defaults.h"
#include "tests/tap.h"

#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

static const struct comm *world_comm;

static struct solution run(struct painted *painted, const char *words)
{
    return solve_scene(world_comm, scene_of_painted(painted), words);
}

static double radiosity(const struct solution *s, int64_t patch)
{
    return s->solver->method.forest->patches[patch].radiosity.band[0];
}

/* Sum over the roots first .. first + count - 1 of area times radiosity over the area. */
static double mean_radiosity(const struct solution *s, int32_t first, int32_t count)
{
    double light = 0.0, area = 0.0;
    for (int32_t root = first; root < first + count; root++) {
        light += forest_area(s->solver->method.forest, root) * radiosity(s, root);
        area += forest_area(s->solver->method.forest, root);
    }
    return light / area;
}

/* True if all radiosities of the roots are numbers within 0 .. most. */
static bool within(const struct solution *s, int32_t first, int32_t count, double most)
{
    const struct forest *forest = s->solver->method.forest;
    for (int64_t p = 0; p < forest->count; p++) {
        int64_t root = forest->patches[p].id.root;
        if (root >= first && root < first + count &&
            !(radiosity(s, p) >= 0.0 && radiosity(s, p) <= most))
            return false;
    }
    return true;
}

static bool everywhere_within(const struct solution *s, double most)
{
    return within(s, 0, s->solver->method.forest->root_count, most);
}

/* Largest relative difference between two solutions, patch by patch by their IDs; infinite if
 * their patches differ. `map[root]` is the root of the second for one of the first. */
static double difference(const struct solution *a, const struct solution *b, double factor)
{
    const struct forest *one = a->solver->method.forest, *two = b->solver->method.forest;
    double worst = one->count == two->count ? 0.0 : HUGE_VAL;
    for (int64_t p = 0; p < one->count && worst < HUGE_VAL; p++) {
        if (id_compare(one->patches[p].id, two->patches[p].id) != 0)
            return HUGE_VAL;
        double off = fabs(radiosity(b, p) - factor * radiosity(a, p));
        worst = fmax(worst, off > 0.0 ? off / (factor * radiosity(a, p)) : 0.0);
    }
    return worst;
}

static bool exact_bits(const struct solution *a, const struct solution *b, double factor)
{
    return difference(a, b, factor) == 0.0;
}

static void add_room(struct painted *painted, int n)
{
    soup_add_box(&painted->soup, point(0, 0, 0), point(1, 1, 1), n, true);
}

/* A room of rho 0.5 with a box that floats in it and a square lamp below its ceiling. */
static struct scene *furnished(double lamp, double box)
{
    struct painted painted = {0};
    add_room(&painted, 1);
    paint(&painted, 0.5, 0.0);
    soup_add_box(&painted.soup, point(0.3, 0.2, 0.1), point(0.7, 0.5, 0.4), 1, false);
    paint(&painted, 0.3, box);
    soup_add_quad(&painted.soup, point(0.4, 0.4, 0.95), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    paint(&painted, 0.0, lamp);
    return scene_of_painted(&painted);
}

/* --- form factors and solver --- */

/* A small square 0.1 of its side under a large one: F = 0.968 from the small one. */
static void test_bounds(void)
{
    struct painted painted = {0};
    soup_add_quad(&painted.soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    soup_add_quad(&painted.soup, point(-4.5, -4.5, 0.1), point(0, 10, 0), point(10, 0, 0), 1);
    paint(&painted, 0.5, 1.0);
    struct solution s = run(&painted, "");
    const struct forest *forest = s.solver->method.forest;
    double largest = 0.0, total = 0.0;
    for (int64_t i = 0; i < s.solver->links.count; i++) {
        const struct link *link = &s.solver->links.items[i];
        double least = fmin(forest_area(forest, link->p), forest_area(forest, link->q));
        bool right = link_area(link) >= 0.0 && (double)link->area <= least;
        largest = right ? fmax(largest, link_area(link) / least) : HUGE_VAL;
        total += link_area(link);
    }
    /* Of the same directions, so more than 0.968: the large square is 10 wide here. */
    double exact = triangle_exchange(&s.scene->triangles[0], &s.scene->triangles[2]) +
                   triangle_exchange(&s.scene->triangles[0], &s.scene->triangles[3]) +
                   triangle_exchange(&s.scene->triangles[1], &s.scene->triangles[2]) +
                   triangle_exchange(&s.scene->triangles[1], &s.scene->triangles[3]);
    double f = total / (2.0 * forest_area(forest, 0)), truth = exact / (2.0 * forest_area(forest, 0));
    tap_ok(largest > 0.5 && largest <= 1.0, "0 <= G <= the smaller area on %lld links (at most %.6f)",
           (long long)s.solver->links.count, largest);
    tap_ok(fabs(f / truth - 1.0) <= 0.01, "a small square below a large one: F %.5f, exact %.5f", f,
           truth);
    solution_free(&s);
}

/* With symmetric closure the mean radiosity is E / (1 - rho) exactly. Both solvers stop by their
 * own bound. */
static void test_false_convergence(void)
{
    static const char *const solvers[] = {"jacobi", "cg"};
    for (int k = 0; k < COUNT(solvers); k++) {
        char words[128];
        struct painted painted = {0};
        soup_add_box(&painted.soup, point(0, 0, 0), point(10, 1, 1), 1, true);
        paint(&painted, 0.999, 0.0);
        painted.ends[0] -= 2;
        paint(&painted, 0.999, 1.0);
        snprintf(words, sizeof words, "--epsilon 1e30 --tolerance 1e-6 --closure symmetric "
                 "--max-iterations 100000 --solver %s", solvers[k]);
        struct solution s = run(&painted, words);
        double emitted = 2.0 * forest_area(s.solver->method.forest, 10) / scene_area(s.scene);
        double exact = emitted / (1.0 - 0.999), mean = mean_radiosity(&s, 0, 12);
        tap_ok(s.vote.converged && fabs(mean / exact - 1.0) <= 1e-6,
               "rho 0.999, tolerance 1e-6, %s: the true error is %.1e (%lld iterations)", solvers[k],
               fabs(mean / exact - 1.0), (long long)s.stats.iterations);
        solution_free(&s);
    }
}

/* Splits only: every refinement keeps all patches and adds some, until nothing is left to split.
 * With epsilon 0 what ends it is the level. */
static void test_termination(void)
{
    static const char *const words[] = {"--epsilon 0 --max-level 3", "--epsilon 1e-5"};
    for (int k = 0; k < COUNT(words); k++) {
        struct scene *scene = furnished(1.0, 0.0);
        scene_prepare_or_exit(scene);
        struct criterion criterion = criterion_parse(words[k]);
        struct octree *octree = octree_create(scene->triangles, scene->planes, scene->input_count);
        struct solver *solver = solver_create(world_comm, scene, octree, &criterion);
        solver_link_roots(solver);
        solver_assign_roots(solver);
        const struct forest *forest = solver->method.forest;
        int passes = 0;
        bool grows = true;
        struct vote vote;
        do {
            int64_t before = forest_leaf_count(forest), split = 0;
            solver_refine(solver);
            split = forest_leaf_count(forest) - before;
            grows = grows && split >= 0;
            solver_close(solver);
            do {
                solver_transfer(solver);
                solver_gather(solver);
                solver_push_pull(solver);
                solver_scatter(solver);
                vote = solver_vote(solver);
            } while (vote.again);
            grows = grows && (split > 0 || vote.split > 0 || vote.converged || passes > 0);
        } while (++passes < 50 && !vote.converged && !vote.diverged);
        tap_ok(grows && vote.converged, "%s: leaves only become more, it ends after %d refinements",
               words[k], passes);
        solver_destroy(solver);
        octree_destroy(octree);
        scene_destroy(scene);
    }
}

/* --- geometry --- */

/* Two rooms with coincident wall planes: the walls as two triangle pairs in one plane. */
static void test_leak(void)
{
    struct painted painted = {0};
    soup_add_box(&painted.soup, point(0, 0, 0), point(1, 1, 1), 1, true);
    paint(&painted, 0.9, 1.0);
    soup_add_box(&painted.soup, point(1, 0, 0), point(2, 1, 1), 1, true);
    soup_add_box(&painted.soup, point(0, 1, 0), point(1.5, 2, 1), 1, true);
    paint(&painted, 0.9, 0.0);
    struct solution s = run(&painted, "--epsilon 1e-4");
    tap_ok(s.vote.converged && within(&s, 12, 24, 0.0),
           "rooms beside a lit one are dark, exactly (%lld links)", (long long)s.stats.links);
    tap_ok(mean_radiosity(&s, 0, 12) > 8.0, "which is not: %.2f", mean_radiosity(&s, 0, 12));
    solution_free(&s);
}

/* A lamp in the plane of the ceiling and a black picture in that of a wall, over them. */
static void test_coplanar(void)
{
    struct painted painted = {0};
    add_room(&painted, 1);
    paint(&painted, 0.5, 0.0);
    soup_add_quad(&painted.soup, point(0.4, 0.4, 1), point(0, 0.2, 0), point(0.2, 0, 0), 1);
    paint(&painted, 0.5, 1.0);
    soup_add_quad(&painted.soup, point(0, 0.25, 0.25), point(0, 0.5, 0), point(0, 0, 0.5), 1);
    paint(&painted, 0.1, 0.0);
    struct solution s = run(&painted, "");
    double direct = 0.0;
    for (int32_t lamp = 12; lamp < 14; lamp++)
        direct += s.stats.emitted_power > 0.0 ? forest_area(s.solver->method.forest, lamp) : 0.0;
    tap_ok(s.vote.converged && everywhere_within(&s, 2.0) && mean_radiosity(&s, 14, 2) > 0.0,
           "a lamp flush with the ceiling, a picture in a wall: defined, and both in the light");
    tap_ok(mean_radiosity(&s, 0, 12) > 0.02 && mean_radiosity(&s, 0, 12) < 0.025,
           "%g", mean_radiosity(&s, 0, 12));
    solution_free(&s);
}

/* Every face of a furnace twice. */
static void test_duplicates(void)
{
    static const char *const words[] = {"", "--closure rows", "--closure symmetric", "--paper"};
    for (int k = 0; k < COUNT(words); k++) {
        char all[100];
        struct painted painted = {0};
        add_room(&painted, 1);
        add_room(&painted, 1);
        paint(&painted, 0.3, 1.0);
        snprintf(all, sizeof all, "--epsilon 1e-3 %s", words[k]);
        struct solution s = run(&painted, all);
        printf("# dup %s: conv %d div %d mean %g closure %g %g %g\n", words[k], s.vote.converged, s.vote.diverged, mean_radiosity(&s, 0, 24), s.stats.closure_min, s.stats.closure_mean, s.stats.closure_max);
        solution_free(&s);
    }
}

/* A furnace in which a box stands on the floor and another goes through it. */
static void test_covered(void)
{
    static const char *const words[] = {"", "--closure rows", "--closure symmetric"};
    for (int k = 0; k < COUNT(words); k++) {
        char all[100];
        struct painted painted = {0};
        add_room(&painted, 1);
        soup_add_box(&painted.soup, point(0.2, 0.2, 0), point(0.6, 0.6, 0.3), 1, false);
        soup_add_box(&painted.soup, point(0.5, 0.5, -0.2), point(0.9, 0.8, 0.2), 1, false);
        paint(&painted, 0.9, 1.0);
        snprintf(all, sizeof all, "--epsilon 1e-4 --tolerance 1e-6 %s", words[k]);
        struct solution s = run(&painted, all);
        double most = 0, least = 1e9;
        for (int64_t p = 0; p < s.solver->method.forest->count; p++) {
            most = fmax(most, radiosity(&s, p));
            if (patch_is_leaf(&s.solver->method.forest->patches[p])) least = fmin(least, radiosity(&s, p)); }
        printf("# covered %s: conv %d div %d most %.9g least %g mean %g closure %g %g %g\n", words[k], s.vote.converged, s.vote.diverged, most,least,mean_radiosity(&s, 0, 36), s.stats.closure_min, s.stats.closure_mean, s.stats.closure_max);
        solution_free(&s);
    }
}

static void test_degenerate(void)
{
    struct scene *plain = furnished(1.0, 0.0), *spoilt = scene_create(plain->input_count + 3, 3);
    for (int i = 0; i < 3; i++)
        spoilt->materials[i] = plain->materials[i];
    for (int32_t i = 0; i < plain->input_count; i++) {
        spoilt->triangles[i] = plain->triangles[i];
        spoilt->material_of[i] = plain->material_of[i];
    }
    struct vec3 a = point(0.1, 0.2, 0.3), b = point(0.5, 0.6, 0.7);
    spoilt->triangles[plain->input_count] = (struct triangle){{a, a, b}};
    spoilt->triangles[plain->input_count + 1] = (struct triangle){{a, a, a}};
    spoilt->triangles[plain->input_count + 2] = (struct triangle){{a, b, vec3_middle(a, b)}};
    struct solution one = solve_scene(world_comm, plain, "--epsilon 1e-4");
    struct solution two = solve_scene(world_comm, spoilt, "--epsilon 1e-4");
    bool same = one.stats.links == two.stats.links;
    for (int32_t root = 0; root < plain->input_count; root++)
        same = same && radiosity(&one, root) == radiosity(&two, root);
    tap_ok(same && one.vote.converged, "faces without area change no bit (%lld links)",
           (long long)one.stats.links);
    solution_free(&one);
    solution_free(&two);
}

/* The furnished room with each coordinate times `scale` plus `offset`. */
static struct scene *moved(double scale, double offset)
{
    struct scene *scene = furnished(1.0, 0.0);
    for (int32_t i = 0; i < scene->input_count; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 *x = &scene->triangles[i].corner[k];
            *x = vec3_add(vec3_scale(*x, scale), point(offset, offset, offset));
        }
    return scene;
}

/* On a mesh that epsilon 0 and a level fix. */
static void test_moved(const char *name, double scale, double offset, double limit)
{
    const char *words = "--epsilon 0 --max-level 2 --tolerance 1e-12";
    struct solution one = solve_scene(world_comm, moved(1.0, 0.0), words);
    struct solution two = solve_scene(world_comm, moved(scale, offset), words);
    double off = difference(&one, &two, 1.0);
    tap_ok(off <= limit, "%s: radiosities within %.1e, at most %g", name, off, limit);
    solution_free(&one);
    solution_free(&two);
}

/* --- light --- */

static void test_emission_scale(void)
{
    static const int powers[] = {-80, -1, 60};
    struct solution one = solve_scene(world_comm, furnished(1.0, 0.25), "--epsilon 1e-4");
    for (int k = 0; k < COUNT(powers); k++) {
        double factor = ldexp(1.0, powers[k]);
        struct solution two = solve_scene(world_comm, furnished(factor, 0.25 * factor),
                                          "--epsilon 1e-4");
        tap_ok(exact_bits(&one, &two, factor), "emission times 2^%d: so is the light, to the bit",
               powers[k]);
        solution_free(&two);
    }
    tap_ok(one.stats.patches > 1000, "on %lld patches", (long long)one.stats.patches);
    solution_free(&one);
}

/* E1, E2 and both on a fixed mesh. */
static void test_linearity(void)
{
    const char *words = "--epsilon 0 --max-level 2 --tolerance 1e-13";
    struct solution one = solve_scene(world_comm, furnished(1.0, 0.0), words);
    struct solution two = solve_scene(world_comm, furnished(0.0, 0.7), words);
    struct solution both = solve_scene(world_comm, furnished(1.0, 0.7), words);
    double worst = 0.0;
    for (int64_t p = 0; p < both.solver->method.forest->count; p++)
        worst = fmax(worst, fabs((radiosity(&one, p) + radiosity(&two, p)) / radiosity(&both, p) -
                                 1.0));
    tap_ok(one.solver->method.forest->count == both.solver->method.forest->count && worst <= 1e-12,
           "light of two lamps is the sum of the light of each (within %.1e)", worst);
    solution_free(&one);
    solution_free(&two);
    solution_free(&both);
}

/* rho_j A_j B_i, where only j emits, is A_i rho_i B_j, where only i does: (A_i / rho_i) R_ij. */
static void test_reciprocity(const char *more)
{
    static const int32_t lamps[] = {0, 5, 13, 22};
    double b[4][4], area[4], rho[4], worst = 0.0, least = HUGE_VAL;
    char words[128];
    snprintf(words, sizeof words, "--epsilon 0 --max-level 1 --tolerance 1e-13 %s", more);
    for (int i = 0; i < 4; i++) {
        struct scene *scene = furnished(0.0, 0.0), *lit = scene_create(scene->input_count, 24);
        for (int32_t t = 0; t < 24; t++) {
            lit->triangles[t] = scene->triangles[t];
            lit->material_of[t] = t;
            lit->materials[t] = material_grey(0.2 + 0.03 * t, t == lamps[i]);
        }
        lit->input_count = 24;
        scene_destroy(scene);
        struct solution s = solve_scene(world_comm, lit, words);
        for (int j = 0; j < 4; j++) {
            b[i][j] = radiosity(&s, lamps[j]);
            area[j] = forest_area(s.solver->method.forest, lamps[j]);
            rho[j] = lit->materials[lamps[j]].reflectance.band[0];
        }
        lit->input_count = 26;
        solution_free(&s);
    }
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++) {
            double there = area[j] * b[i][j] / rho[j], back = area[i] * b[j][i] / rho[i];
            worst = fmax(worst, fabs(there / back - 1.0));
            least = fmin(least, fmin(b[i][j], b[j][i]));
        }
    tap_ok(least > 0.0 && worst <= 1e-12, "the response is reciprocal%s%s (within %.1e)",
           *more ? ", " : "", more, worst);
}

/* A light 1e-4 of the room wide: E = B A cos^2 / (pi d^2) at the floor below and beside. */
static void test_tiny_light(const char *words)
{
    const double size = 1e-4, b = 1e8;
    struct painted painted = {0};
    soup_add_quad(&painted.soup, point(-0.5, -0.5, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&painted, 0.5, 0.0);
    soup_add_quad(&painted.soup, point(0, 0, 0.5), point(0, size, 0), point(size, 0, 0), 1);
    paint(&painted, 0.0, b);
    struct solution s = run(&painted, words);
    struct shading *shading = shade(&s);
    static const double at[] = {0.0, 0.03, 0.1, 0.2, 0.3, 0.4};
    double worst = 0.0;
    for (int i = 0; i < COUNT(at); i++) {
        double d2 = 0.25 + at[i] * at[i] * (1.0 + 0.49);
        double e = b * size * size * 0.25 / (3.14159265358979323846 * d2 * d2);
        double shown = shown_at(&s, shading, 0, 2, point(at[i], -0.7 * at[i], 0)) / 0.5;
        worst = fmax(worst, fabs(shown / e - 1.0));
    }
    int level = 0;
    for (int64_t p = 0; p < s.solver->method.forest->count; p++)
        level = (int)fmax(level, id_level(s.solver->method.forest->patches[p].id));
    tap_ok(s.vote.converged && worst <= 0.005, "a light of 1e-4 of the room, %s: off by %.2f %%, "
           "level %d, %lld links", words, 100.0 * worst, level, (long long)s.stats.links);
    shading_destroy(shading);
    solution_free(&s);
}

/* A large lamp, a screen with a hole, a receiver close to it: each point sees the lamp wherever it
 * sees the hole, so the hole is a lamp of its size. */
static void test_hole(const char *name, double width, double height, const char *words,
                      double limit)
{
    struct painted painted = {0};
    struct vec3 low = point(-0.5 * width, -0.5 * height, 0.25);
    soup_add_quad(&painted.soup, point(-0.25, -0.25, 0), point(0.5, 0, 0), point(0, 0.5, 0), 1);
    paint(&painted, 0.5, 0.0);
    soup_add_quad(&painted.soup, point(-2, -2, 0.5), point(0, 4, 0), point(4, 0, 0), 1);
    paint(&painted, 0.0, 1.0);
    soup_add_quad(&painted.soup, point(-3, -3, 0.25), point(6, 0, 0), point(0, 3 + low.y, 0), 1);
    soup_add_quad(&painted.soup, point(-3, -low.y, 0.25), point(6, 0, 0), point(0, 3 + low.y, 0), 1);
    soup_add_quad(&painted.soup, point(-3, low.y, 0.25), point(3 + low.x, 0, 0),
                  point(0, height, 0), 1);
    soup_add_quad(&painted.soup, point(-low.x, low.y, 0.25), point(3 + low.x, 0, 0),
                  point(0, height, 0), 1);
    paint(&painted, 0.0, 0.0);
    struct vec3 hole[4] = {low, point(low.x, -low.y, 0.25), point(-low.x, -low.y, 0.25),
                           point(-low.x, low.y, 0.25)};
    struct vec3 floor[4] = {point(-0.25, -0.25, 0), point(0.25, -0.25, 0), point(0.25, 0.25, 0),
                            point(-0.25, 0.25, 0)};
    double exact = polygon_exchange(hole, 4, floor, 4) / polygon_area(floor, 4);
    struct solution s = run(&painted, words);
    double seen = mean_radiosity(&s, 0, 2) / 0.5;
    tap_ok(s.vote.converged && fabs(seen / exact - 1.0) <= limit,
           "%s, %s: %.6f of the lamp, exact %.6f: off by %.2f %%, at most %g %% (%lld links, %g s)", name,
           words, seen, exact, 100.0 * fabs(seen / exact - 1.0), 100.0 * limit,
           (long long)s.stats.links, s.seconds);
    solution_free(&s);
}

/* A furnace inside out: all light escapes, and the report says so. */
static void test_flipped(void)
{
    struct painted painted = {0};
    soup_add_box(&painted.soup, point(0, 0, 0), point(1, 1, 1), 1, false);
    paint(&painted, 0.5, 1.0);
    struct solution s = run(&painted, "--closure rows");
    tap_ok(s.vote.converged && s.stats.escaped_power == s.stats.emitted_power &&
           s.stats.absorbed_power == 0.0 && s.stats.closure_max == 0.0 &&
           everywhere_within(&s, 1.0), "a furnace inside out: all that is emitted escapes");
    solution_free(&s);
    add_room(&painted, 1);
    struct triangle *t = &painted.soup.items[5];
    *t = (struct triangle){{t->corner[0], t->corner[2], t->corner[1]}};
    paint(&painted, 0.5, 1.0);
    s = run(&painted, "--closure rows --epsilon 1e-3");
    tap_ok(s.vote.converged && s.stats.escaped_power > 0.05 * s.stats.emitted_power &&
           everywhere_within(&s, 2.0), "one of 12 faces flipped: %.1f %% escape, none is made up",
           100.0 * s.stats.escaped_power / s.stats.emitted_power);
    solution_free(&s);
}

/* Two facing plates: what is emitted is absorbed or escapes. */
static void test_open(void)
{
    struct painted painted = {0};
    soup_add_quad(&painted.soup, point(0, 0, 0), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&painted, 0.8, 1.0);
    soup_add_quad(&painted.soup, point(0, 0, 1), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&painted, 0.4, 0.0);
    struct solution s = run(&painted, "--tolerance 1e-12");
    /* B_2 = rho_2 F B_1, B_1 = E + rho_1 F B_2 if each were constant; F of C-11. */
    const double f = 0.199824895698387;
    double b1 = mean_radiosity(&s, 0, 2), exact = 1.0 / (1.0 - 0.8 * 0.4 * f * f);
    double balance = s.stats.absorbed_power + s.stats.escaped_power - s.stats.emitted_power;
    tap_ok(fabs(balance) <= 1e-9 * s.stats.emitted_power && s.stats.escaped_power > 0.0,
           "two plates: absorbed + escaped = emitted, within %.1e", fabs(balance));
    printf("# b1 %.9g exact %.9g\n", b1, exact);
    solution_free(&s);
}

/* Pixels of a picture taken inside an unevenly refined furnace. */
static void test_cracks(void)
{
    struct solution s = solve_scene(world_comm, furnished(1.0, 1.0), "--epsilon 1e-4");
    struct forest *forest = s.solver->method.forest;
    for (int64_t p = 0; p < forest->count; p++)
        forest->patches[p].radiosity = (struct rgb){{2.0, 2.0, 2.0}};
    struct shading *shading = shade(&s);
    struct camera camera = {.eye = point(0.05, 0.07, 0.9), .at = point(0.6, 0.5, 0.3),
                            .up = point(0, 0, 1), .fov = 100.0, .width = 200, .height = 200};
    float *pixels = render_rows(shading, s.octree, &camera, 2, 0, 1);
    int off = 0;
    for (int i = 0; i < 3 * 200 * 200; i++)
        off += !(pixels[i] == 2.0f);
    tap_ok(off == 0 && s.stats.leaves > 1000, "no cracks: all 40000 pixels over %lld leaves are "
           "the same (%d are not)", (long long)s.stats.leaves, off / 3);
    alloc_free(pixels);
    shading_destroy(shading);
    solution_free(&s);
}

/* The furnished room with faces in another order and corners turned. */
static void test_order(const char *words)
{
    struct scene *plain = furnished(1.0, 0.0), *mixed = scene_create(plain->input_count, 3);
    int32_t count = plain->input_count;
    for (int m = 0; m < 3; m++)
        mixed->materials[m] = plain->materials[m];
    for (int32_t i = 0; i < count; i++) {
        int32_t to = (i * 11 + 5) % count; /* 26 faces: 11 has no factor in common */
        struct triangle t = plain->triangles[i];
        int k = i % 3;
        mixed->triangles[to] = (struct triangle){{t.corner[k], t.corner[(k + 1) % 3],
                                                  t.corner[(k + 2) % 3]}};
        mixed->material_of[to] = plain->material_of[i];
    }
    struct solution one = solve_scene(world_comm, plain, words);
    struct solution two = solve_scene(world_comm, mixed, words);
    double worst = 0.0;
    for (int32_t i = 0; i < count; i++)
        if (radiosity(&one, i) > 0.0)
            worst = fmax(worst, fabs(radiosity(&two, (i * 11 + 5) % count) / radiosity(&one, i) - 1));
    double a = one.stats.absorbed_power, b = two.stats.absorbed_power;
    printf("# order %s: worst root %g absorbed %g links %lld %lld\n", words, worst, fabs(a/b-1), (long long)one.stats.links, (long long)two.stats.links);
    solution_free(&one);
    solution_free(&two);
}

int main(int argc, char **argv)
{
    struct comm comm;
    comm_start(&comm, &argc, &argv);
    world_comm = &comm;
    test_bounds();
    test_false_convergence();
    test_termination();
    test_leak();
    test_coplanar();
    test_duplicates();
    test_covered();
    test_degenerate();
    test_moved("a million times as large", 1e6, 0.0, 1e-12);
    test_moved("a millionth as large", 1e-6, 0.0, 1e-12);
    test_moved("moved by a million sizes", 1.0, 1e6, 1e-6);
    test_emission_scale();
    test_linearity();
    test_reciprocity("");
    test_reciprocity("--closure symmetric");
    test_tiny_light("");
    test_tiny_light("--epsilon 1e-6 --max-level 15 --min-area 0");
    test_tiny_light("--epsilon 1e-7 --max-level 15 --min-area 0");
    test_hole("slit", 0.02, 0.4, "", 1);
    test_hole("slit", 0.02, 0.4, "--epsilon 1e-7", 1);
    test_hole("slit", 0.02, 0.4, "--epsilon 1e-8", 1);
    test_hole("pinhole", 0.03, 0.03, "", 1);
    test_hole("pinhole", 0.03, 0.03, "--epsilon 1e-7", 1);
    test_hole("pinhole", 0.03, 0.03, "--epsilon 1e-8", 1);
    test_hole("pinhole", 0.03, 0.03, "--epsilon 1e-9", 1);
    test_flipped();
    test_open();
    test_cracks();
    test_order("--epsilon 0 --max-level 0 --tolerance 1e-13");
    test_order("--epsilon 0 --max-level 2 --tolerance 1e-13");
    test_order("--epsilon 1e-4");
    comm_stop(&comm);
    return tap_done();
}
