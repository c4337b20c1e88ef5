/* Tests of io/picture/viewpoint.h. Proved are, by many more rays than the choice is made
 * with: in a room the eye is within and sees nothing but fronts, far away for the most
 * part; a scene that is no room is seen from outside, whole, by its fronts; up is where
 * it should be; and what stands below a sky fills the picture. */
#include "io/picture/viewpoint.h"

#include <stdio.h>

#include "io/scene/sky.h"
#include "tests/reading.h"
#include "tests/scenes.h"
#include "tests/tap.h"

enum { SIDE = 100 }; /* rays along a side of a picture */

/* Shares of a picture's rays, by the surface they meet. */
struct sight {
    double fronts, backs; /* share of all rays */
    double depth;         /* mean distance of fronts, relative to the scene's diagonal */
};

/* Finds where ray i of a picture ends. False: nowhere. */
static bool ray_ends(const struct scene *scene, const struct octree *octree,
                     const struct camera *camera, bool fronts_only, int i,
                     struct octree_hit *hit)
{
    struct octree_counts counts = {0};
    double x = (i % SIDE + 0.5) * camera->width / SIDE;
    double y = (i / SIDE + 0.5) * camera->height / SIDE;
    struct vec3 eye = scene_from_input(scene, camera->eye),
                direction = camera_ray(camera, x, y);
    if (!octree_first_hit(octree, eye, direction, fronts_only, hit, &counts))
        return false;
    octree_hit_weights(octree, eye, direction, hit);
    return true;
}

static struct sight look(const struct scene *scene, const struct octree *octree,
                         const struct camera *camera)
{
    struct sight sight = {0.0, 0.0, 0.0};
    struct vec3 eye = scene_from_input(scene, camera->eye);
    double diagonal = vec3_length(vec3_sub(scene->high, scene->low));
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct octree_hit hit;
        if (!ray_ends(scene, octree, camera, false, i, &hit))
            continue;
        struct vec3 point = corners_mean(
            scene->triangles[hit.triangle].corner,
            (struct vec3){hit.weight[0], hit.weight[1], hit.weight[2]});
        bool front = scene_root_on(scene, hit.triangle, hit.front) >= 0;
        sight.fronts += front;
        sight.backs += !front;
        sight.depth += front ? vec3_length(vec3_sub(point, eye)) / diagonal : 0.0;
    }
    sight.depth /= sight.fronts > 0.0 ? sight.fronts : 1.0;
    sight.fronts /= SIDE * SIDE;
    sight.backs /= SIDE * SIDE;
    return sight;
}

/* A scene, its camera, and the view from there. */
struct shot {
    struct scene *scene;
    struct octree *octree;
    struct camera camera;
    struct sight sight;
};

/* Returns the share of the rays of a picture that show a material. */
static double share_of(const struct shot *shot, int32_t material)
{
    const struct scene *scene = shot->scene;
    const struct camera *camera = &shot->camera;
    int met = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct octree_hit hit;
        met += ray_ends(scene, shot->octree, camera, camera->fronts_only, i, &hit) &&
               scene_root_on(scene, hit.triangle, hit.front) >= 0 &&
               scene->material_of[hit.triangle] == material;
    }
    return (double)met / (SIDE * SIDE);
}

/* Returns the slope of the line of sight, downwards, z up. */
static double slope_of(const struct camera *camera)
{
    struct vec3 to = vec3_sub(camera->at, camera->eye);
    return -to.z / sqrt(to.x * to.x + to.y * to.y);
}

static bool is_inside(const struct scene *scene, const struct camera *camera)
{
    struct vec3 eye = scene_from_input(scene, camera->eye), low = scene->low,
                high = scene->high;
    return eye.x > low.x && eye.x < high.x && eye.y > low.y && eye.y < high.y &&
           eye.z > low.z && eye.z < high.z;
}

static struct shot shoot(struct scene *scene, int width, int height)
{
    struct shot shot = {.scene = prepared(scene)};
    shot.octree = octree_of(scene);
    shot.camera = viewpoint_choose(scene, shot.octree, NULL, width, height);
    shot.sight = look(scene, shot.octree, &shot.camera);
    return shot;
}

static void shot_free(struct shot *shot)
{
    octree_destroy(shot->octree);
    scene_destroy(shot->scene);
}

static struct shot shoot_soup(struct soup *soup, int width, int height)
{
    return shoot(scene_of_soup(soup), width, height);
}

/* A box that glows, each side of n x n cells. */
static struct shot shoot_box(struct vec3 low, struct vec3 high, int n, bool inwards,
                             int width, int height)
{
    struct soup soup = {0};
    soup_add_box(&soup, low, high, n, inwards);
    paint(&soup, 0.5, 1.0);
    return shoot_soup(&soup, width, height);
}

/* A square with this radiosity. */
static struct shot shoot_square(struct vec3 u, struct vec3 v, double emission)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(0, 0, 0), u, v, 1);
    paint(&soup, 0.5, emission);
    return shoot_soup(&soup, 512, 512);
}

static void describe(const struct shot *shot)
{
    const struct camera *camera = &shot->camera;
    printf(
        "# eye %.3f %.3f %.3f at %.3f %.3f %.3f: %.3f fronts, %.3f backs, depth %.3f\n",
        camera->eye.x, camera->eye.y, camera->eye.z, camera->at.x, camera->at.y,
        camera->at.z, shot->sight.fronts, shot->sight.backs, shot->sight.depth);
}

/* --- rooms --- */

/* In the room, with fronts alone and mean depth `depth` or more; consumes the shot. */
static void check_room(const char *name, struct shot shot, double depth, bool z_up)
{
    const struct camera *camera = &shot.camera;
    bool right = is_inside(shot.scene, camera) && !camera->fronts_only &&
                 shot.sight.fronts == 1.0 && shot.sight.depth > depth &&
                 camera->up.y == !z_up && camera->up.z == z_up;
    if (!tap_ok(right, "from within: %s", name))
        describe(&shot);
    shot_free(&shot);
}

static const struct vec3 ZERO = {0.0, 0.0, 0.0};

static void test_far_away(void)
{
    struct vec3 far = {1e6, 1e6, 1e6};
    check_room("a room far from the origin",
               shoot_box(far, vec3_add(far, point(5, 4, 3)), 2, true, 99, 99), 0.3, true);
}

/* Along a corridor the picture must show its length. */
static void test_corridor(void)
{
    struct shot shot = shoot_box(ZERO, point(10, 1, 1), 1, true, 512, 512);
    struct vec3 to = vec3_sub(shot.camera.at, shot.camera.eye);
    tap_ok(fabs(to.x) > 4.0 * fabs(to.z) &&
               (to.x > 0.0) == (shot.camera.eye.x < 5.0), "down the corridor");
    check_room("a corridor of 1 : 10", shot, 0.08, false);
}

/* A ceiling lamp along `up`, a table, a cupboard in a corner up to the ceiling. */
static struct soup furnished(bool z_up)
{
    struct soup soup = {0};
    soup_add_box(&soup, ZERO, point(4, 5, 2.5), 1, true);
    soup_add_box(&soup, point(0.01, 0.01, 0.01), point(1.2, 1.5, 2.49), 1, false);
    soup_add_box(&soup, point(2, 2, 0.7), point(3, 3.5, 0.75), 1, false);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(1.5, 2, 2.45), point(0, 1, 0), point(1, 0, 0), 1);
    paint(&soup, 0.5, 1.0);
    for (int64_t i = 0; i < soup.count && !z_up; i++)
        for (int k = 0; k < 3; k++) { /* (x, y, z) to (x, z, -y) */
            struct vec3 *x = &soup.items[i].corner[k];
            *x = point(x->x, x->z, -x->y);
        }
    return soup;
}

static void test_furniture(void)
{
    for (int z_up = 0; z_up < 2; z_up++) {
        struct soup soup = furnished(z_up);
        check_room(z_up ? "furniture, z up" : "furniture, y up",
                   shoot_soup(&soup, 400, 300), 0.2, z_up);
    }
}

/* A two-sided room, higher than wide: nothing but the front of a lamp at the top tells
 * which way is up, whether its back shines, too, or not. */
static void test_two_sided_lamps(void)
{
    for (int both = 0; both < 2; both++) {
        struct soup soup = {0};
        soup_add_box(&soup, ZERO, point(2, 2, 3), 1, true);
        paint(&soup, 0.5, 0.0);
        soup_add_quad(&soup, point(0.5, 0.5, 2.95), point(0, 1, 0), point(1, 0, 0), 1);
        paint(&soup, 0.5, 1.0);
        struct scene *scene = scene_of_soup(&soup);
        scene->two_sided = true;
        scene->two_sided_lamps = both;
        check_room(both ? "a lamp that shines both ways" : "a lamp in a two-sided room",
                   shoot(scene, 512, 512), 0.2, true);
    }
}

/* A tower along y, whose shortest side is along z: with twins it is a room from within,
 * and the lamp on its ceiling says that y is up. */
static void test_tower(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, ZERO, point(4, 20, 3), 1, false);
    for (int storey = 1; storey < 20; storey++)
        soup_add_quad(&soup, point(0.5, 1.0 * storey, 0.5), point(0, 0, 2.5),
                      point(3.5, 0, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(1, 9.9, 1), point(1, 0, 0), point(0, 0, 1), 1);
    paint(&soup, 0.5, 1.0);
    struct scene *scene = scene_of_soup(&soup);
    scene->two_sided = true;
    check_room("a two-sided tower", shoot(scene, 512, 512), 0.01, false);
}

/* Two rooms, the larger one dark, no light between them. */
static void test_dark_room(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, ZERO, point(8, 3, 6), 1, true);
    int32_t lit = (int32_t)soup.count;
    soup_add_box(&soup, point(8.1, 0, 0), point(11, 3, 6), 1, true);
    struct world world = world_make(scene_of_soup(&soup));
    const struct octree *octree = world.octree;
    struct camera any = viewpoint_choose(world.scene, octree, NULL, 512, 512);
    for (int32_t i = lit; i < world.scene->input_count; i++)
        world.model.forest->radiosity[i] = (struct rgb){{0.0, 0.1, 0.0}};
    struct camera seen =
        viewpoint_choose(world.scene, octree, world.model.forest, 512, 512);
    tap_ok(any.eye.x < 8.0 && seen.eye.x > 8.1, "of two rooms, the one with light");
    world_free(&world);
}

/* --- open scenes --- */

/* From outside, fronts alone, at least `share` of the picture; consumes the shot. */
static void check_open(const char *name, struct shot shot, double share)
{
    const struct camera *camera = &shot.camera;
    bool right = !is_inside(shot.scene, camera) && camera->fronts_only &&
                 shot.sight.fronts > share && shot.sight.backs == 0.0 &&
                 camera->up.y == 1.0 && camera->up.z == 0.0;
    if (!tap_ok(right, "from outside: %s", name))
        describe(&shot);
    shot_free(&shot);
}

static void test_objects(void)
{
    struct vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    struct soup soup = {0};
    soup_add_sphere(&soup, 3.0, 3);
    paint(&soup, 0.5, 1.0);
    check_open("a sphere", shoot_soup(&soup, 512, 512), 0.2);
    check_open("a box", shoot_box(ZERO, point(2, 3, 1), 1, false, 300, 200), 0.1);
    check_open("a floor", shoot_square(z, x, 1.0), 0.05);
    check_open("a ceiling", shoot_square(x, z, 0.0), 0.05);
    check_open("a wall", shoot_square(y, z, 1.0), 0.1);
}

/* A lamp at the ceiling is seen from below, also where other things are two-sided. */
static void test_lamp_from_below(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, ZERO, point(1, 0, 0), point(0, 0, 1), 1);
    paint(&soup, 0.5, 1.0);
    struct scene *scene = scene_of_soup(&soup);
    scene->two_sided = true;
    check_open("a lamp with a black back", shoot(scene, 512, 512), 0.05);
}

/* Floor and lamp along z. */
static void test_lamp_above(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, ZERO, point(9, 0, 0), point(0, 9, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(4, 4, 9), point(0, 0.1, 0), point(0.1, 0, 0), 1);
    paint(&soup, 0.5, 1.0);
    struct shot shot = shoot_soup(&soup, 512, 512);
    tap_ok(shot.camera.up.z == 1.0 && shot.camera.fronts_only &&
               shot.sight.fronts > 0.1 && shot.camera.eye.z > 0.0,
           "a floor with a lamp above it along z, seen from above");
    shot_free(&shot);
}

/* The measured box is seen as in its own view file, through its open front. */
static void test_cornell(void)
{
    struct obj_repairs repairs = {0};
    struct error error = {0};
    struct scene *scene = obj_read("scenes/cornell.obj", &repairs, &error);
    if (!tap_ok(scene != NULL, "the Cornell box"))
        return;
    struct shot shot = shoot(scene, 512, 512);
    struct vec3 eye = shot.camera.eye;
    tap_ok(fabs(eye.x - 278.0) < 10.0 && fabs(eye.y - 273.0) < 10.0 &&
               fabs(eye.z + 800.0) < 40.0,
           "is seen as in scenes/cornell.view");
    check_open("the Cornell box", shot, 0.9);
}

/* Five slabs of one material, y up, open to one side below a sky: the picture is of the
 * inside. */
static void test_open_box(void)
{
    static const struct vec3 OPEN[] = {{1, 0, 0}, {0, 0, -1}};
    for (int k = 0; k < 2; k++) {
        struct soup soup = {0};
        for (int axis = 0; axis < 3; axis++)
            for (int sign = -1; sign <= 1; sign += 2) {
                double half[3] = {5, 5, 5}, middle[3] = {0, 0, 0};
                half[axis] = 0.1;
                middle[axis] = 5.0 * sign;
                if (sign * vec3_axis(OPEN[k], axis) > 0.0)
                    continue;
                soup_add_box(&soup,
                             point(middle[0] - half[0], middle[1] - half[1],
                                   middle[2] - half[2]),
                             point(middle[0] + half[0], middle[1] + half[1],
                                   middle[2] + half[2]), 1, false);
            }
        paint(&soup, 0.5, 0.0);
        struct scene *scene = scene_of_soup(&soup);
        sky_add(scene, (struct rgb){{1, 1, 1}});
        struct shot shot = shoot(scene, 512, 512);
        struct vec3 from = vec3_unit(vec3_sub(shot.camera.eye, shot.camera.at));
        tap_ok(vec3_dot(from, OPEN[k]) > 0.6, "a box of one material, open to %g %g %g",
               OPEN[k].x, OPEN[k].y, OPEN[k].z);
        shot_free(&shot);
    }
}

/* Of a thing below a sky, seen from above, the horizon is not in the picture. */
static void test_horizon(void)
{
    struct soup soup = {0};
    soup_add_sphere(&soup, 1.0, 3);
    paint(&soup, 0.5, 0.0);
    struct scene *scene = scene_of_soup(&soup);
    sky_add(scene, (struct rgb){{1, 1, 1}});
    struct shot shot = shoot(scene, 640, 480);
    double sky = share_of(&shot, scene->material_count - 1);
    tap_ok(sky == 0.0 && shot.sight.fronts > 0.2, "a ball, and %.1f %% sky",
           100.0 * sky);
    shot_free(&shot);
}

/* --- small boxes, and things below a sky --- */

/* A closed box with a lamp is seen from outside, level, with all that is in it. */
static void test_small_box(void)
{
    static const int SIZES[][2] = {{512, 512}, {200, 700}, {1600, 400}};
    for (int size = 0; size < 3; size++) {
        struct soup soup = {0};
        soup_add_box(&soup, ZERO, point(1, 1, 1), 1, true);
        paint(&soup, 0.5, 0.0);
        soup_add_quad(&soup, point(0.3, 0.3, 0.99), point(0, 0.4, 0), point(0.4, 0, 0),
                      1);
        paint(&soup, 0.5, 1.0);
        soup_add_box(&soup, point(0.2, 0.2, 0.001), point(0.5, 0.5, 0.4), 1, false);
        paint(&soup, 0.2, 0.0);
        struct shot shot = shoot_soup(&soup, SIZES[size][0], SIZES[size][1]);
        double lamp = share_of(&shot, 1), thing = share_of(&shot, 2);
        tap_ok(!is_inside(shot.scene, &shot.camera) && shot.camera.up.z == 1.0 &&
                   slope_of(&shot.camera) == 0.0 && lamp > 0.0 && thing > 0.01,
               "a small closed box, %d x %d: %.1f %% lamp, %.1f %% thing",
               SIZES[size][0], SIZES[size][1], 100.0 * lamp, 100.0 * thing);
        shot_free(&shot);
    }
}

/* Half a ball that shines inwards, z up. */
static void add_dome(struct soup *soup, double radius)
{
    struct soup ball = {0};
    soup_add_sphere(&ball, radius, 3);
    for (int64_t i = 0; i < ball.count; i++) {
        struct triangle t = ball.items[i];
        if (t.corner[0].z + t.corner[1].z + t.corner[2].z > 0.0)
            soup_add(soup, reversed(t));
    }
    soup_free(&ball);
    paint(soup, 0.0, 1.0);
}

/* Things on a large plain below a dome, in two materials: ground and things are the first
 * two. Seen are both, with slopes in a range; consumes the soup. */
static void check_sky(const char *name, struct soup *soup, double ground, double things,
                      const double slopes[2])
{
    double radius = 300.0;
    add_dome(soup, radius);
    struct soup twice = *soup;
    twice.items = alloc_array((size_t)soup->count, sizeof *twice.items);
    for (int64_t i = 0; i < soup->count; i++)
        twice.items[i] = soup->items[i];
    for (int sides = 1; sides <= 2; sides++) {
        struct scene *scene = scene_of_soup(sides == 1 ? soup : &twice);
        scene->two_sided = sides == 2;
        struct shot shot = shoot(scene, 512, 384);
        double slope = slope_of(&shot.camera);
        double shares[] = {share_of(&shot, 0), share_of(&shot, 1)};
        tap_ok(shot.camera.up.z == 1.0 && slope >= slopes[0] && slope <= slopes[1] &&
                   shares[0] > ground && shares[1] > things,
               "%s below a sky, %d-sided: %.1f %% ground, %.1f %% things, slope %.2f",
               name, sides, 100.0 * shares[0], 100.0 * shares[1], slope);
        shot_free(&shot);
    }
}

/* A square of ground around the origin, z up. */
static void add_ground(struct soup *soup, double side)
{
    soup_add_quad(soup, point(-side / 2, -side / 2, 0), point(side, 0, 0),
                  point(0, side, 0), 1);
    paint(soup, 0.3, 0.0);
}

/* From 35 degrees above: low things. From less: others. Tangents. */
static const double HIGH[] = {0.57, 0.84}, MEDIUM[] = {0.3, 0.4};

static void test_below_sky(void)
{
    struct soup soup = {0};
    add_ground(&soup, 30.0);
    soup_add_box(&soup, point(-5, -4, 0), point(5, 4, 60), 1, false);
    paint(&soup, 0.5, 0.0);
    check_sky("a tower", &soup, 0.02, 0.05, MEDIUM);

    soup = (struct soup){0};
    add_ground(&soup, 60.0);
    for (int k = 0; k < 25; k++) {
        double x = k / 5 * 10.0 - 24.0, y = k % 5 * 10.0 - 24.0;
        soup_add_box(&soup, point(x, y, 0), point(x + 7, y + 7, 4 + k * 7 % 11), 1,
                     false);
    }
    paint(&soup, 0.5, 0.0);
    check_sky("a city", &soup, 0.05, 0.15, HIGH);
}

/* A street is seen along its road, into which no other view looks. */
static void test_street(void)
{
    struct soup soup = {0};
    soup_add_quad(&soup, point(-80, -5, 0), point(160, 0, 0), point(0, 10, 0), 1);
    paint(&soup, 0.3, 0.0);
    for (int k = 0; k < 32; k++) {
        double x = k / 2 * 10.0 - 80.0, y = k % 2 ? 5 : -17;
        soup_add_box(&soup, point(x, y, 0), point(x + 10, y + 12, 10 + k * 5 % 7), 1,
                     false);
    }
    paint(&soup, 0.5, 0.0);
    check_sky("a street", &soup, 0.01, 0.05, HIGH);
}

/* A floor and walls of 2.7 m, with lamps that shine down: from above into the rooms, also
 * where walls have one side. */
static void test_plan(void)
{
    for (int thin = 0; thin < 2; thin++) {
        struct soup soup = {0};
        soup_add_quad(&soup, ZERO, point(12, 0, 0), point(0, 9, 0), 1);
        paint(&soup, 0.3, 0.0);
        for (int k = 0; k < 4; k++) { /* two along x, two along y */
            struct vec3 low = {k == 1 ? 12 : 0, k == 3 ? 9 : 0, 0.001};
            struct vec3 along = k < 2 ? point(0, 9, 0) : point(12, 0, 0);
            struct vec3 far = vec3_add(low, vec3_add(along, point(0.1, 0.1, 2.7)));
            if (thin)
                soup_add_quad(&soup, low, along, point(0, 0, 2.7), 1);
            else
                soup_add_box(&soup, low, far, 1, false);
        }
        soup_add_box(&soup, point(5, 0, 0.001), point(5.1, 7, 2.7), 1, false);
        paint(&soup, 0.5, 0.0);
        soup_add_quad(&soup, point(2, 4, 2.6), point(0, 1, 0), point(1, 0, 0), 1);
        soup_add_quad(&soup, point(8, 4, 2.6), point(0, 1, 0), point(1, 0, 0), 1);
        paint(&soup, 0.5, 1.0);
        struct shot shot = shoot_soup(&soup, 512, 384);
        double slope = slope_of(&shot.camera), floor = share_of(&shot, 0);
        tap_ok(slope >= HIGH[0] && slope <= HIGH[1] && floor > 0.1,
               "a plan%s: %.1f %% floor, slope %.2f", thin ? " of thin walls" : "",
               100.0 * floor, slope);
        shot_free(&shot);
    }
}

/* OBJ does not say which axis is up: without lamps that shine down, a floor does. */
static void test_floor_tells_up(void)
{
    for (int z_up = 0; z_up < 2; z_up++) {
        struct soup soup = {0};
        struct vec3 a = {9, 0, 0}, b = z_up ? point(0, 9, 0) : point(0, 0, -9);
        struct vec3 low = {3, z_up ? 3 : 0.1, z_up ? 0.1 : -4};
        soup_add_quad(&soup, ZERO, a, b, 1);
        soup_add_box(&soup, low, vec3_add(low, point(1, 1, 1)), 1, false);
        paint(&soup, 0.5, 0.0);
        struct shot shot = shoot_soup(&soup, 512, 512);
        tap_ok(shot.camera.up.z == z_up && shot.camera.up.y == !z_up,
               "a block on a floor, %c up", z_up ? 'z' : 'y');
        shot_free(&shot);
    }
}

int main(void)
{
    test_far_away();
    test_corridor();
    test_furniture();
    test_two_sided_lamps();
    test_tower();
    test_dark_room();
    test_objects();
    test_lamp_from_below();
    test_lamp_above();
    test_cornell();
    test_open_box();
    test_horizon();
    test_small_box();
    test_below_sky();
    test_street();
    test_plan();
    test_floor_tells_up();
    return tap_done();
}
