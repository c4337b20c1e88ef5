/* Tests of rad/patch.h: the size of a patch, splitting, areas that add up exactly, the
 * walk depth first. (The same tree in any order of creation: checksum.c.) */
#include "rad/patch.h"

#include <string.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { ROOTS = 6, PATHS = 300 };

/* A prepared scene of random triangles; number 4 has no area. */
static struct scene *make_scene(void)
{
    struct soup soup = {0};
    struct random random = random_seed(1);
    soup_add_random(&soup, &random, ROOTS, 0.5, 0.3);
    soup.items[4].corner[1] = soup.items[4].corner[0];
    paint(&soup, 0, 0);
    paint(&soup, 0, 0);
    struct scene *scene = scene_of_soup(&soup);
    scene->material_of[1] = 1;
    scene->materials[1].emission = (struct rgb){{1.0, 2.0, 3.0}};
    return prepared(scene);
}

static bool same_id(struct patch_id a, struct patch_id b)
{
    return a.root == b.root && a.hierarchy == b.hierarchy;
}

static void test_creation(struct scene *scene)
{
    struct forest *forest = forest_create(scene);
    tap_ok(sizeof(struct patch) <= 64, "a patch takes %d bytes",
           (int)sizeof(struct patch));
    bool right = forest->count == ROOTS && forest->root_count == ROOTS;
    for (int32_t r = 0; r < ROOTS; r++) {
        const struct patch *patch = &forest->patches[r];
        right = right && patch_is_leaf(patch) && patch->parent == -1 &&
                same_id(patch->id, id_of_root((uint32_t)r)) && patch->flux[0] == 0 &&
                forest->radiosity[r].band[2] == (r == 1 ? 3.0 : 0.0) &&
                forest_area(forest, r) == scene->areas[r] &&
                forest_material(forest, r) == &scene->materials[r == 1];
    }
    tap_ok(right, "roots have their emission as radiosity");
    tap_ok(forest_count(forest).leaves == ROOTS - 1 &&
               forest_count(forest).patches == ROOTS - 1,
           "roots without an area are not counted");
    forest_destroy(forest);
    forest_destroy(NULL);
}

static void test_split(struct scene *scene)
{
    struct forest *forest = forest_create(scene);
    forest->radiosity[2] = (struct rgb){{0.5, 0.25, 7.0}};
    forest->patches[2].flux[1] = 99;
    forest_split(forest, 2);
    int32_t first = forest->patches[2].children;
    bool right = first == ROOTS && forest->count == ROOTS + 4;
    for (int k = 0; k < 4; k++) {
        const struct patch *child = &forest->patches[first + k];
        right = right && same_id(child->id,
                                 id_child(id_of_root(2), k)) && child->parent == 2 &&
                patch_is_leaf(child) && child->flux[0] == 0 && child->flux[1] == 0 &&
                memcmp(&forest->radiosity[first + k], &forest->radiosity[2],
                       sizeof(struct rgb)) == 0;
    }
    tap_ok(right && forest->patches[2].flux[1] == 99,
           "children take over the radiosity; the flux stays with the parent");
    forest_split(forest, 2);
    tap_ok(forest->count == ROOTS + 4 && forest->patches[2].children == first,
           "an inner patch is not split again");
    tap_ok(forest_count(forest).leaves == ROOTS + 2 &&
               forest_count(forest).patches == ROOTS + 3,
           "leaves and patches are counted");
    forest_split(forest, 4);
    tap_ok(forest_count(forest).leaves == ROOTS + 2 &&
               forest_count(forest).patches == ROOTS + 3,
           "but not those without an area");
    forest_destroy(forest);
}

/* Areas are exact fractions of the root's. Those of the triangles are computed from
 * corners that are rounded at each of up to 15 levels: the relative error of a
 * difference of corners is then
 * 1e-16 / 2^-15 = 4e-12, and slivers have more. */
static void test_areas(struct scene *scene)
{
    struct forest *forest = forest_create(scene);
    struct random random = random_seed(2);
    for (int i = 0; i < PATHS; i++)
        forest_reach(forest, random_id(&random, ROOTS, ID_MAX_LEVEL));
    bool exact = true;
    double worst = 0.0;
    for (int32_t p = 0; p < forest->count; p++) {
        double area = forest_area(forest, p), sum = 0.0;
        struct triangle t = forest_triangle(forest, p);
        if (area > 0.0)
            worst = fmax(worst, fabs(triangle_area(&t) / area - 1.0));
        if (patch_is_leaf(&forest->patches[p]))
            continue;
        for (int k = 0; k < 4; k++)
            sum += forest_area(forest, forest->patches[p].children + k);
        exact = exact && sum == area;
    }
    tap_ok(exact, "the areas of children sum to the parent's exactly, down to level 15");
    tap_ok(worst < 1e-10, "and they are those of the triangles");
    forest_destroy(forest);
}

/* Whether the patch that is reached has the ID. Reaching may move `patches`: it comes
 * first. */
static bool reaches(struct forest *forest, struct patch_id id)
{
    int32_t patch = forest_reach(forest, id);
    return same_id(forest->patches[patch].id, id);
}

static void test_reach(struct scene *scene)
{
    static struct patch_id ids[PATHS];
    struct random random = random_seed(3);
    for (int i = 0; i < PATHS; i++)
        ids[i] = random_id(&random, ROOTS, 8);
    struct forest *first = forest_create(scene);
    bool found = true;
    for (int i = 0; i < PATHS; i++)
        found = reaches(first, ids[i]) && found;
    int64_t count = first->count;
    for (int i = 0; i < PATHS; i++)
        found = reaches(first, ids[i]) && found;
    tap_ok(found && first->count == count,
           "the patch reached has the ID, and is there the next time");
    forest_destroy(first);
}

/* --- the walk --- */

/* Depth first order: at the first step in which two paths differ the smaller child comes
 * first, and a path comes before those that it begins. */
static bool comes_before(struct patch_id a, struct patch_id b)
{
    int level_a = id_level(a), level_b = id_level(b);
    for (int k = 0; k < level_a && k < level_b; k++)
        if (id_step(a, k) != id_step(b, k))
            return id_step(a, k) < id_step(b, k);
    return level_a < level_b;
}

static bool is_below(struct patch_id a, struct patch_id top)
{
    while (id_level(a) > id_level(top))
        a.hierarchy >>= 2;
    return same_id(a, top);
}

static void test_walk(struct scene *scene)
{
    struct forest *forest = forest_create(scene);
    struct random random = random_seed(4);
    for (int i = 0; i < PATHS; i++)
        forest_reach(forest, random_id(&random, ROOTS, 6));
    int64_t seen = 0;
    int32_t leaf = forest_next_leaf(forest, -1);
    bool ordered = true, skipped = true, listed = true;
    for (int32_t root = 0; root < ROOTS; root++) {
        for (int32_t p = root; p >= 0; seen++) {
            if (patch_is_leaf(&forest->patches[p]) && root != 4) {
                listed = listed && leaf == p;
                leaf = leaf < 0 ? leaf : forest_next_leaf(forest, leaf);
            }
            int32_t next = forest_next(forest, p, true);
            if (next >= 0)
                ordered = ordered && forest->patches[next].id.root == (uint32_t)root &&
                          comes_before(forest->patches[p].id, forest->patches[next].id);
            int32_t over = next;
            while (over >= 0 && is_below(forest->patches[over].id, forest->patches[p].id))
                over = forest_next(forest, over, true);
            skipped = skipped && forest_next(forest, p, false) == over;
            p = next;
        }
    }
    tap_ok(ordered && seen == forest->count,
           "the walk visits each patch once, depth first");
    tap_ok(skipped, "and skips descendants of a patch on request");
    tap_ok(listed && leaf == -1, "leaves follow each other, but for those without area");
    forest_destroy(forest);
}

/* --- geometry --- */

static void test_triangles(struct scene *scene)
{
    struct forest *forest = forest_create(scene);
    int32_t patch = forest_reach(forest, id_child(id_child(id_of_root(3), 3), 1));
    struct triangle t = scene_root_triangle(scene, 3);
    t = triangle_child(&t, 3);
    t = triangle_child(&t, 1);
    struct triangle u = forest_triangle(forest, patch);
    tap_ok(memcmp(&t, &u, sizeof t) == 0, "corners follow the path from the root");
    forest_destroy(forest);
}

int main(void)
{
    struct scene *scene = make_scene();
    test_creation(scene);
    test_split(scene);
    test_areas(scene);
    test_reach(scene);
    test_walk(scene);
    test_triangles(scene);
    scene_destroy(scene);
    return tap_done();
}
