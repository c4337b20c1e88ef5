/* Tests of rad/beyond/closure.h: which leaves are enclosed, what new patches inherit, and the factors.
 * (Row sums are measured in tests/rad/pushpull.c, and closed in tests/mpi/conjugate.c and exact.c.) */
#include "rad/beyond/closure.h"

#include "tests/scenes.h"
#include "tests/tap.h"

static struct vec3 point(double x, double y, double z)
{
    return (struct vec3){x, y, z};
}

/* A room [0, 1]^3, or all of it but the side on top. Sides come in pairs of triangles: low x, high
 * x, low y, high y, low z, high z. */
static struct soup room_of(bool open, int n)
{
    struct soup soup = {0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), n, true);
    if (open)
        soup.count -= 2 * n * n;
    return soup;
}

static struct world world_of(struct soup *soup, int levels)
{
    struct world world = world_make(scene_of_soup(soup, 1));
    soup_free(soup);
    for (int level = 0; level < levels; level++)
        for (int64_t p = 0, count = world.model.forest->count; p < count; p++)
            forest_split(world.model.forest, (int32_t)p);
    return world;
}

/* How many leaves of roots first to end - 1 have to be closed; -1 if the answer changes when asked
 * again or costs rays again. */
static int due_leaves(struct world *world, int32_t first, int32_t end)
{
    struct closure closure = {.kind = CLOSURE_ROWS};
    const struct forest *forest = world->model.forest;
    closure_extend(&closure, forest);
    int due[2] = {0, 0};
    int64_t rays[2];
    for (int turn = 0; turn < 2; turn++) {
        for (int32_t p = 0; p < forest->count; p++) {
            int32_t root = (int32_t)forest->patches[p].id.root;
            if (root >= first && root < end && patch_is_leaf(&forest->patches[p]))
                due[turn] += closure_is_due(&closure, &world->model, p);
        }
        rays[turn] = world->model.counts.rays + world->model.counts.node_tests;
    }
    closure_free(&closure);
    return due[0] == due[1] && rays[0] == rays[1] && rays[0] > 0 ? due[0] : -1;
}

static void test_rooms(void)
{
    struct soup soup = room_of(false, 1);
    struct world world = world_of(&soup, 2);
    tap_ok(due_leaves(&world, 0, 12) == 12 * 16, "all leaves of a closed room, asked once each");
    world_free(&world);
    soup = room_of(true, 1);
    world = world_of(&soup, 2);
    tap_ok(due_leaves(&world, 0, 10) == 0, "no leaf of an open one");
    world_free(&world);
    soup = (struct soup){0};
    soup_add_box(&soup, point(0, 0, 0), point(1, 1, 1), 1, false);
    world = world_of(&soup, 1);
    tap_ok(due_leaves(&world, 0, 12) == 0, "none outside of a box");
    world_free(&world);
}

/* A room whose floor (low z, roots 8 and 9) is cut into leaves of 1/8, and a box that stands on it
 * on [1/4, 3/4]^2. Under it lie 16 squares of 1/8, two leaves each. */
static void test_standing_box(void)
{
    struct soup soup = room_of(false, 1);
    soup_add_box(&soup, point(0.25, 0.25, 0), point(0.75, 0.75, 0.5), 1, false);
    struct world world = world_of(&soup, 3);
    const struct forest *forest = world.model.forest;
    struct closure closure = {.kind = CLOSURE_ROWS};
    closure_extend(&closure, forest);
    int under = 0, beside = 0, wrong = 0;
    for (int32_t p = 0; p < forest->count; p++) {
        uint32_t root = forest->patches[p].id.root;
        if ((root != 8 && root != 9) || !patch_is_leaf(&forest->patches[p]))
            continue;
        struct triangle t = forest_triangle(forest, p);
        struct vec3 centre = triangle_centroid(&t), low = world.scene->triangles[8].corner[0];
        double size = vec3_length(vec3_sub(world.scene->triangles[8].corner[1], low));
        double x = (centre.x - low.x) / size, y = (centre.y - low.y) / size;
        bool covered = x > 0.25 && x < 0.75 && y > 0.25 && y < 0.75;
        under += covered;
        beside += !covered;
        wrong += closure_is_due(&closure, &world.model, p) == covered;
    }
    tap_ok(under == 32 && beside == 96 && wrong == 0,
           "a box on the floor: %d leaves under it are not, %d beside it are", under, beside);
    closure_free(&closure);
    /* Its bottom faces the floor from no distance, and sees its front. */
    tap_ok(due_leaves(&world, 0, 8) == 8 * 64 && due_leaves(&world, 10, 12) == 2 * 64,
           "walls and ceiling are");
    world_free(&world);
}

/* A panel half-way up, its front upwards, wide enough to be seen from all of the floor. */
static void test_visible_back(void)
{
    static const struct {
        bool two_sided, lamp, two_sided_lamps, way_out;
        const char *name;
    } CASES[] = {
        {false, false, false, true, "a back that is seen is a way out; a front is not"},
        {true, false, false, false, "two-sided, it is no way out"},
        {true, true, false, true, "but that of a lamp is"},
        {true, true, true, false, "unless lamps are two-sided, too"}};
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        struct soup soup = room_of(false, 1);
        soup_add_quad(&soup, point(0.1, 0.1, 0.5), point(0.8, 0, 0), point(0, 0.8, 0), 1);
        struct scene *scene = scene_of_soup(&soup, 2);
        scene->two_sided = CASES[i].two_sided;
        scene->two_sided_lamps = CASES[i].two_sided_lamps;
        scene->materials[1] = material_grey(0.5, CASES[i].lamp ? 1.0 : 0.0);
        scene->material_of[12] = scene->material_of[13] = 1;
        soup_free(&soup);
        struct world world = world_make(scene);
        int floor = due_leaves(&world, 8, 10), ceiling = due_leaves(&world, 10, 12);
        tap_ok(floor == (CASES[i].way_out ? 0 : 2) && ceiling == 2, "%s", CASES[i].name);
        world_free(&world);
    }
}

/* A hole in the ceiling is seen by few rays of a floor leaf, but its ancestors look too: where one
 * of them sees it, no leaf is closed. */
static void test_ancestors(void)
{
    struct soup soup = room_of(false, 1);
    struct world world = world_of(&soup, 2);
    struct closure closure = {.kind = CLOSURE_ROWS};
    struct forest *forest = world.model.forest;
    closure_extend(&closure, forest);
    int32_t child = forest->patches[3].children + 2, leaf = forest->patches[child].children + 1;
    int32_t other = forest->patches[forest->patches[3].children].children;
    closure.enclosure[child] = OPEN;
    tap_ok(!closure_is_due(&closure, &world.model, leaf) &&
               closure_is_due(&closure, &world.model, other),
           "an open ancestor opens all its leaves, and no others");
    closure.enclosure[child] = COVERED;
    tap_ok(closure_is_due(&closure, &world.model, leaf), "one that is covered in part does not");
    closure.enclosure[leaf] = COVERED;
    tap_ok(!closure_is_due(&closure, &world.model, leaf),
           "a leaf that is covered in part is open");
    closure_free(&closure);
    world_free(&world);
}

static void test_extending(void)
{
    struct soup soup = room_of(false, 1);
    struct world world = world_of(&soup, 0);
    struct closure closure = {.kind = CLOSURE_ROWS};
    struct forest *forest = world.model.forest;
    closure_extend(&closure, forest);
    bool ones = closure.count == forest->count;
    for (int64_t p = 0; p < closure.count; p++)
        ones = ones && closure.factor[p] == 1.0 && closure.enclosure[p] == UNKNOWN;
    tap_ok(ones, "factors begin as 1, and nothing is known");
    closure.factor[5] = 0.75;
    closure.enclosure[5] = ENCLOSED;
    forest_split(forest, 5);
    closure_extend(&closure, forest);
    bool inherits = closure.count == forest->count && closure.factor[5] == 0.75 &&
                    closure.enclosure[5] == ENCLOSED;
    for (int k = 0; k < 4; k++) {
        int32_t child = forest->patches[5].children + k;
        inherits = inherits && closure.factor[child] == 0.75 && closure.enclosure[child] == UNKNOWN;
    }
    tap_ok(inherits, "new patches inherit the factor of their parents, but look for themselves");
    closure.factor[1] = 0.5;
    bool right = closure_receives(&closure, 1) == 0.5 && closure_weight(&closure, 1) == 2.0;
    closure.kind = CLOSURE_NONE;
    right = right && closure_receives(&closure, 1) == 1.0 && closure_weight(&closure, 1) == 1.0;
    tap_ok(right, "a leaf's factor, and its weight");
    closure_free(&closure);
    tap_ok(!closure.factor && !closure.enclosure && closure.count == 0, "a closure is freed");
    world_free(&world);
}

int main(void)
{
    test_rooms();
    test_standing_box();
    test_visible_back();
    test_ancestors();
    test_extending();
    return tap_done();
}
