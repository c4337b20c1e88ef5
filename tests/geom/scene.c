/* Tests of geom/scene.h: the same bits at every power of two, stability far from the
 * origin, twins, repairs and their counts, doubles, areas and powers, and the errors. */
#include "geom/scene.h"

#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { COUNT = 200 };

static struct soup make_soup(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_random(&soup, &random, COUNT, 2.0, 0.5);
    return soup;
}

/* The same with corners that are whole numbers. */
static struct soup make_grid(void)
{
    struct soup soup = make_soup();
    for (int64_t i = 0; i < 3 * soup.count; i++) {
        struct vec3 *x = &soup.items[i / 3].corner[i % 3];
        *x = point(rint(1024.0 * x->x), rint(1024.0 * x->y), rint(1024.0 * x->z));
    }
    return soup;
}

/* The prepared scene of the soup, each corner scaled and then moved. Empties the soup. */
static struct scene *scene_moved(struct soup soup, double scale, double offset)
{
    for (int64_t i = 0; i < 3 * soup.count; i++) {
        struct vec3 *x = &soup.items[i / 3].corner[i % 3];
        *x = vec3_add(vec3_scale(*x, scale), point(offset, -offset, offset));
    }
    paint(&soup, 0.5, 1.0);
    return prepared(scene_of_soup(&soup));
}

static bool same_geometry(const struct scene *a, const struct scene *b)
{
    size_t count = (size_t)a->input_count;
    return memcmp(a->triangles, b->triangles, count * sizeof *a->triangles) == 0 &&
           memcmp(a->planes, b->planes, count * sizeof *a->planes) == 0 &&
           memcmp(a->areas, b->areas, count * sizeof *a->areas) == 0 &&
           memcmp(&a->low, &b->low, sizeof a->low) == 0 &&
           memcmp(&a->high, &b->high, sizeof a->high) == 0;
}

static void test_scaling(void)
{
    struct scene *plain = scene_moved(make_soup(), 1.0, 0.0);
    bool right = true;
    for (int k = -400; k <= 400; k += 25) {
        struct scene *scaled = scene_moved(make_soup(), ldexp(1.0, k), 0.0);
        right = right && same_geometry(plain, scaled) &&
                scaled->place.exponent == plain->place.exponent + k;
        scene_destroy(scaled);
    }
    tap_ok(right, "a scene scaled by 2^k has the same bits in scene units");
    struct scene *thrice = scene_moved(make_soup(), 3.0, 0.0);
    tap_ok(!same_geometry(plain, thrice), "a scene scaled by 3 has not");
    scene_destroy(thrice);
    scene_destroy(plain);
}

static double largest_difference(const struct scene *a, const struct scene *b)
{
    double largest = 0.0;
    for (int32_t i = 0; i < 3 * a->input_count; i++) {
        struct vec3 d = vec3_sub(a->triangles[i / 3].corner[i % 3],
                                 b->triangles[i / 3].corner[i % 3]);
        largest = fmax(largest, vec3_length(d));
    }
    return largest;
}

static void test_offset(void)
{
    struct scene *plain = scene_moved(make_soup(), 1.0, 0.0);
    struct scene *far = scene_moved(make_soup(), 1.0, 5e6);
    double difference = largest_difference(plain, far);
    /* Numbers near 5e6 are 2^-30 = 9.3e-10 apart. A corner rounds by half of that, the
     * centre by as much again from rounded bounds; three axes; a scene unit is 8 here. */
    tap_ok(plain->place.exponent == 3 && difference < 9.3e-10 * 1.7321 / 8.0,
           "a scene 1e6 sizes from the origin moves by its rounding alone");
    struct scene *grid = scene_moved(make_grid(), 1.0, 0.0);
    struct scene *far_grid = scene_moved(make_grid(), 1.0, 5e9);
    tap_ok(same_geometry(grid, far_grid), "corners on a grid keep their bits there");
    scene_destroy(plain);
    scene_destroy(far);
    scene_destroy(grid);
    scene_destroy(far_grid);
}

static void test_box(void)
{
    struct soup soup = make_soup();
    bool fits = true, back = true;
    for (double scale = 0.37; scale < 3.0; scale += 0.01) {
        struct scene *scene = scene_moved(make_soup(), scale, 100.0);
        struct vec3 size = vec3_sub(scene->high, scene->low);
        double extent = fmax(size.x, fmax(size.y, size.z));
        /* Rounding moves a bound by a unit in the last place of 100. */
        fits = fits && extent >= 0.5 - 1e-13 && extent <= 1.0 + 1e-13 &&
               fabs(scene->low.x + scene->high.x) < 1e-13 &&
               fabs(scene->low.z + scene->high.z) < 1e-13;
        struct vec3 x = scene_to_input(scene, scene->triangles[7].corner[1]);
        struct vec3 y = vec3_scale(soup.items[7].corner[1], scale);
        struct vec3 moved = vec3_add(y, point(100, -100, 100));
        struct vec3 again = scene_from_input(scene, x);
        back = back && vec3_length(vec3_sub(x, moved)) < 1e-13 &&
               vec3_length(vec3_sub(again, scene->triangles[7].corner[1])) < 1e-13;
        scene_destroy(scene);
    }
    tap_ok(fits, "the box has its longest side in 1/2 .. 1 and its centre at the origin");
    tap_ok(back, "points go back to input units");
    soup_free(&soup);
}

/* The normals of the file, each turned to the front of the root. */
static void test_normals(void)
{
    struct scene *scene = scene_moved(make_soup(), 1.0, 0.0);
    scene->two_sided = scene->two_sided_lamps = true;
    struct vec3 none = scene_root_normal(scene, COUNT - 1, 2);
    tap_ok(vec3_length(none) == 0.0, "no normals, no normal");
    scene_add_normals(scene);
    bool right = true;
    for (int32_t i = 0; i < COUNT; i++) {
        for (int k = 0; k < 3; k++) {
            struct vec3 side = scene->triangles[i].corner[k];
            struct vec3 x = vec3_add(scene->planes[i].normal, vec3_scale(side, 0.1 * k));
            scene->normals[3 * i + k] = vec3_scale(x, i % 2 ? 1.0 : -1.0);
        }
        for (int k = 0; k < 3; k++) {
            struct vec3 front = scene_root_normal(scene, i, k);
            struct vec3 back = scene_root_normal(scene, i + COUNT, (3 - k) % 3);
            right = right && vec3_dot(front, scene->planes[i].normal) >= 0.0 &&
                    fabs(vec3_dot(front, scene->normals[3 * i + k])) ==
                        vec3_dot(front, front) &&
                    vec3_length(vec3_add(front, back)) == 0.0;
        }
    }
    tap_ok(right, "normals are turned to the front, those of twins to the other");
    scene_destroy(scene);
}

static void test_twins(void)
{
    struct scene *scene = scene_moved(make_soup(), 1.0, 0.0);
    double area = scene_area(scene), power = scene_emitted_power(scene);
    tap_ok(scene_root_count(scene) == COUNT, "a root for each triangle");
    scene->two_sided = scene->two_sided_lamps = true;
    tap_ok(scene_root_count(scene) == 2 * COUNT, "two if two-sided");
    bool right = true;
    for (int32_t i = 0; i < COUNT; i++) {
        int32_t twin = i + COUNT;
        struct triangle t = scene_root_triangle(scene, i),
                        u = scene_root_triangle(scene, twin);
        struct plane p = scene_root_plane(scene, i), q = scene_root_plane(scene, twin);
        right = right && memcmp(&t, &scene->triangles[i], sizeof t) == 0 &&
                memcmp(&t.corner[0], &u.corner[0], sizeof t.corner[0]) == 0 &&
                memcmp(&t.corner[1], &u.corner[2], sizeof t.corner[0]) == 0 &&
                memcmp(&t.corner[2], &u.corner[1], sizeof t.corner[0]) == 0;
        right = right && p.normal.x == -q.normal.x && p.normal.y == -q.normal.y &&
                p.normal.z == -q.normal.z && p.offset == -q.offset &&
                vec3_dot(triangle_cross(&u), q.normal) > 0.0;
        right = right && scene_input_of(scene, i) == i &&
                scene_input_of(scene, twin) == i &&
                scene_root_area(scene, twin) == scene_root_area(scene, i) &&
                scene_root_material(scene, twin) == scene_root_material(scene, i);
    }
    tap_ok(
        right,
        "a twin has the corners (a, c, b), the other side of the plane, all else alike");
    /* 200 more terms of a sum of positive numbers: 400 roundings. */
    tap_ok(fabs(scene_area(scene) / area - 2.0) < 1e-13 &&
               fabs(scene_emitted_power(scene) / power - 2.0) < 1e-13,
           "twice the area and twice the power");
    scene_destroy(scene);
}

/* True if lamps have black backs, without a root, and other backs are fronts of
 * twins. */
static bool lamps_are_single(const struct scene *scene)
{
    bool right = true;
    for (int32_t i = 0; i < COUNT; i++) {
        bool lamp = scene->material_of[i] == 1;
        int32_t twin = i + COUNT;
        struct plane plane = scene_root_plane(scene, twin);
        right = right && scene_has_twin(scene, i) == !lamp &&
                scene_root_on(scene, i, true) == i &&
                scene_root_on(scene, i, false) == (lamp ? -1 : twin) &&
                scene_root_area(scene, i) == scene->areas[i] &&
                scene_root_area(scene, twin) == (lamp ? 0.0 : scene->areas[i]) &&
                plane.offset == (lamp ? 0.0 : -scene->planes[i].offset) &&
                (vec3_length(plane.normal) > 0.0) == !lamp;
    }
    return right;
}

/* Every third triangle is a lamp, of one band alone. */
static void test_lamps(void)
{
    struct soup soup = make_soup();
    paint(&soup, 0.0, 0.0);
    paint_with(&soup, (struct material){.emission = {{0.0, 0.0, 3.0}}});
    struct scene *scene = scene_of_soup(&soup);
    double area = 0.0;
    for (int32_t i = 0; i < COUNT; i += 3)
        scene->material_of[i] = 1;
    prepared(scene);
    for (int32_t i = 0; i < COUNT; i++)
        area += scene->material_of[i] == 1 ? scene->areas[i] : 2.0 * scene->areas[i];
    double power = scene_emitted_power(scene);
    tap_ok(scene_root_on(scene, 1, true) == 1 && scene_root_on(scene, 1, false) == -1 &&
               !scene_has_twin(scene, 1),
           "no twins, black backs");
    scene->two_sided = true;
    tap_ok(scene_root_count(scene) == 2 * COUNT && lamps_are_single(scene),
           "two-sided: a lamp has no twin, and its back is black");
    /* The zeros of the absent roots leave the sums' bits as they are. */
    tap_ok(scene_emitted_power(scene) == power &&
               fabs(scene_area(scene) / area - 1.0) < 1e-13,
           "the power of one side of each lamp, the area of both sides of all else");
    scene->two_sided_lamps = true;
    tap_ok(scene_has_twin(scene, 0) && scene_root_on(scene, 0, false) == COUNT &&
               scene_root_area(scene, COUNT) == scene->areas[0] &&
               fabs(scene_emitted_power(scene) / power - 2.0) < 1e-13,
           "with two-sided lamps they have, and twice the power");
    scene->two_sided = false;
    tap_ok(!scene_has_twin(scene, 0) && scene_root_count(scene) == COUNT,
           "but not in a scene without twins");
    scene_destroy(scene);
}

static void test_power(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), point(6, 0, 0), point(0, 3, 0), 1);
    paint_with(&soup, (struct material){.emission = {{1, 2, 4}}});
    paint(&soup, 0.0, 0.0);
    struct scene *scene = scene_of_soup(&soup);
    scene->material_of[1] = 1;
    prepared(scene);
    tap_ok(scene->place.exponent == 3 && scene_area_unit(scene) == 64.0,
           "a size of 6 has the unit 8");
    /* Dyadic corners: all of this is exact. */
    tap_ok(scene_area(scene) * scene_area_unit(scene) == 18.0, "the area in input units");
    tap_ok(scene_emitted_power(scene) * scene_area_unit(scene) == 9.0 * 7.0,
           "the power in input units, over roots and bands");
    tap_ok(!material_is_dark(&scene->materials[0]) &&
               material_is_dark(&scene->materials[1]),
           "dark roots neither reflect nor emit");
    scene_destroy(scene);
}

static void test_clamping(void)
{
    struct soup soup = make_soup();
    paint_with(&soup, (struct material){.reflectance = {{1.0, 0.5, 7.0}}});
    paint_with(&soup, (struct material){.reflectance = {{0.9995, 0.0, 0.5}}});
    paint_with(&soup, (struct material){.reflectance = {{0.0, 0.0, 1.0}}});
    paint(&soup, 0.0, 0.0);
    struct scene *scene = scene_of_soup(&soup);
    struct scene_repairs repairs;
    struct error error = {0};
    bool done = scene_prepare(scene, &repairs, &error);
    tap_ok(done && repairs.clamped == 2, "materials are clamped once each");
    const double *first = scene->materials[0].reflectance.band;
    tap_ok(first[0] == 0.999 && first[1] == 0.5 && first[2] == 0.999 &&
               scene->materials[2].reflectance.band[2] == 0.999,
           "bands of 1 or more become 0.999, the others stay");
    tap_ok(scene->materials[1].reflectance.band[0] == 0.9995,
           "a reflectance below 1 stays");
    scene_destroy(scene);
}

static void test_degenerate(void)
{
    struct soup soup = make_soup();
    struct scene *plain = scene_moved(make_soup(), 1.0, 0.0);
    int32_t expected = 0;
    for (int32_t i = 0; i < COUNT; i += 9, expected++) {
        struct triangle *t = &soup.items[i];
        t->corner[2] = i % 2 ? t->corner[0] : vec3_middle(t->corner[0], t->corner[1]);
    }
    struct scene *scene = scene_of_soup(&soup);
    struct scene_repairs repairs = {.degenerate = -1};
    struct error error = {0};
    bool done = scene_prepare(scene, &repairs, &error);
    tap_ok(done && repairs.degenerate == expected && repairs.clamped == 0,
           "degenerate triangles are counted");
    bool dropped = true, kept = scene->input_count == COUNT;
    for (int32_t i = 0; i < COUNT; i++) {
        struct vec3 normal = scene->planes[i].normal;
        if (i % 9 == 0)
            dropped =
                dropped && scene->areas[i] == 0.0 && vec3_dot(normal, normal) == 0.0;
        else
            kept = kept && scene->areas[i] > 0.0 &&
                   memcmp(&scene->triangles[i], &plain->triangles[i],
                          sizeof(struct triangle)) == 0;
    }
    tap_ok(dropped, "they have no area and no plane");
    tap_ok(kept, "the others keep their numbers");
    scene_destroy(scene);
    scene_destroy(plain);
}

/* A bent quad, that is there again as another material from its second corner on, and
 * from behind; and a triangle. */
static struct scene *doubled(struct scene_repairs *repairs)
{
    const struct vec3 c[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}, {0, 0, 2}};
    const int corner[][3] = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {1, 3, 0},
                             {3, 2, 1}, {3, 1, 0}, {0, 1, 4}};
    struct scene *scene = scene_create(7, 3);
    struct error error = {0};
    scene->materials[0] = material_grey(0.5, 1.0);
    scene->materials[1] = scene->materials[0];
    scene->materials[2] = material_grey(0.25, 0.0);
    scene_add_normals(scene);
    for (int32_t i = 0; i < 7; i++) {
        for (int k = 0; k < 3; k++) {
            scene->triangles[i].corner[k] = c[corner[i][k]];
            scene->normals[3 * i + k] = point(1.0 + corner[i][k], 0, 0);
        }
        scene->groups.goes_on[i] = i % 2 == 1;
        scene->material_of[i] = i == 2 ? 1 : i == 3 ? 2 : 0;
    }
    tap_ok(scene_prepare(scene, repairs, &error), "a scene of doubles is prepared");
    return scene;
}

static void test_doubles(void)
{
    struct scene_repairs repairs;
    struct scene *scene = doubled(&repairs);
    const double *areas = scene->areas;
    tap_ok(repairs.doubles == 2 && repairs.unlike == 1 && repairs.degenerate == 0 &&
               areas[2] == 0.0 && areas[3] == 0.0 && areas[0] > 0.0 && areas[1] > 0.0 &&
               vec3_length(scene->planes[2].normal) == 0.0 && areas[6] > 0.0,
           "of doubles the first is kept; those of another material are counted");
    bool alike = true, placed = true;
    for (int32_t i = 4; i < 6; i++)
        for (int k = 0; k < 3; k++) {
            struct vec3 x = scene->triangles[i].corner[k];
            struct vec3 front = scene->triangles[i - 4].corner[(3 - k) % 3];
            alike = alike && memcmp(&x, &front, sizeof x) == 0;
            placed = placed && scene->normals[3 * i + k].x ==
                                   scene->normals[3 * (i - 4) + (3 - k) % 3].x;
        }
    tap_ok(alike && scene->planes[4].normal.x == -scene->planes[0].normal.x &&
               areas[4] == areas[0],
           "the back of a bent quad is cut like its front");
    tap_ok(placed, "and its normals stay at their corners");
    double once = scene_area(scene);
    scene->two_sided = scene->two_sided_lamps = true;
    tap_ok(!scene_has_twin(scene, 0) && !scene_has_twin(scene, 5) &&
               scene_root_on(scene, 1, false) == -1 && scene_has_twin(scene, 6) &&
               scene_area(scene) == once + areas[6],
           "a face that is modelled from both sides has no twins");
    uint64_t hash = scene_hash(scene);
    scene->areas[2] = scene->areas[3] = 1.0;
    tap_ok(scene_hash(scene) != hash, "doubles that are kept make another scene");
    scene_destroy(scene);
}

/* --- errors --- */

/* Whether a scene of one triangle, its last corner given, is refused as bad input. */
static bool is_refused(struct vec3 a, struct vec3 b, struct vec3 c)
{
    struct scene *scene = scene_create(1, 1);
    scene->triangles[0] = (struct triangle){{a, b, c}};
    struct scene_repairs repairs;
    struct error error = {0};
    bool refused = !scene_prepare(scene, &repairs, &error) && error.code == EXIT_USAGE &&
                   error.text[0] != '\0';
    scene_destroy(scene);
    return refused;
}

static void test_errors(void)
{
    struct vec3 o = {0, 0, 0}, x = {1, 0, 0}, y = {0, 1, 0}, p = {3, 4, 5};
    struct scene *scene = scene_create(0, 0);
    struct scene_repairs repairs;
    struct error error = {0};
    tap_ok(!scene_prepare(scene, &repairs, &error) && error.code == EXIT_USAGE &&
               strcmp(error.text, "the scene has no faces") == 0,
           "no faces");
    scene_destroy(scene);
    tap_ok(!is_refused(o, x, y), "one triangle is a scene");
    tap_ok(is_refused(p, p, p), "a single point");
    tap_ok(is_refused(o, x, x), "only degenerate faces");
    tap_ok(is_refused(o, x, point(0, HUGE_VAL, 0)) &&
               is_refused(o, x, point(0, -HUGE_VAL, 0)) &&
               is_refused(point(HUGE_VAL, 0, 0), x, y),
           "infinite coordinates");
    tap_ok(is_refused(o, x, point(0, 1e200, 0)) &&
               is_refused(o, point(1e-200, 0, 0), point(0, 1e-200, 0)),
           "extents that leave the range of the numbers");
    double nan = HUGE_VAL - HUGE_VAL;
    tap_ok(is_refused(point(nan, 0, 0), x, y) && is_refused(o, point(1, nan, 0), y) &&
               is_refused(o, x, point(0, 1, nan)),
           "coordinates that are not numbers");
}

int main(void)
{
    test_scaling();
    test_offset();
    test_box();
    test_normals();
    test_twins();
    test_lamps();
    test_power();
    test_clamping();
    test_degenerate();
    test_doubles();
    test_errors();
    return tap_done();
}
