/* Tests of io/picture/viewpoint.h, by 10,000 rays a picture. In a room the eye is within
 * and sees lit fronts alone; any other scene is seen whole, from outside, and shows
 * what it is about: of a box its inside, of a plan its floor, of a lamp its front. */
#include "io/picture/viewpoint.h"

#include "tests/reading.h"
#include "tests/scenes.h"
#include "tests/tap.h"

enum { SIDE = 100 }; /* rays along a side of a picture */

static const struct vec3 ZERO = {0.0, 0.0, 0.0};
struct shot {
    struct world world;
    struct camera camera;
    double shown[9]; /* share of the picture by material; [7]: backs */
};

static struct shot shoot(struct world world, const struct forest *forest)
{
    struct shot shot = {.world = world};
    const struct scene *scene = world.scene;
    shot.camera = viewpoint_choose(scene, world.octree, forest, 400, 300);
    struct vec3 eye = scene_from_input(scene, shot.camera.eye);
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct octree_hit hit;
        struct octree_counts counts = {0};
        struct vec3 ray = camera_ray(&shot.camera, (i % SIDE + 0.5) * 400 / SIDE,
                                     (i / SIDE + 0.5) * 300 / SIDE);
        bool passing = shot.camera.fronts_only;
        if (octree_first_hit(world.octree, eye, ray, passing, &hit, &counts))
            shot.shown[scene_root_on(scene, hit.triangle, hit.front) < 0 ? 7
                       : scene->material_of[hit.triangle]] += 1.0 / (SIDE * SIDE);
    }
    return shot;
}

/* Consumes the soup. */
static struct shot shoot_soup(struct soup *soup)
{
    return shoot(world_make(scene_of_soup(soup)), NULL);
}

static void add_box(struct soup *soup, struct vec3 low, struct vec3 high, bool inwards)
{
    soup_add_box(soup, low, high, 1, inwards);
    paint(soup, 0.5, 0.0);
}

static void add_lamp(struct soup *soup, double x, double y, double z)
{
    soup_add_quad(soup, point(x, y, z), point(0, 1, 0), point(1, 0, 0), 1);
    paint(soup, 0.5, 1.0);
}

/* From inside backs are not passed. Consumes the shot. */
static void check(const char *name, struct shot shot, bool inside, bool right)
{
    tap_ok(shot.camera.fronts_only == !inside && shot.shown[7] == 0.0 && right,
           "%s: %.3f %.3f %.3f %.3f", name, shot.shown[0], shot.shown[1],
           shot.shown[2], shot.shown[3]);
    world_free(&shot.world);
}

/* A room with a cupboard, a table and a lamp; and the level of a game, its floors and
 * walls solid boxes. */
static void test_rooms(void)
{
    struct soup soup = {0};
    add_box(&soup, ZERO, point(4, 5, 2.5), true);
    add_lamp(&soup, 1.5, 2, 2.45);
    add_box(&soup, point(0.01, 0.01, 0.01), point(1.2, 1.5, 2.49), false);
    add_box(&soup, point(2, 2, 0.7), point(3, 3.5, 0.75), false);
    struct shot shot = shoot_soup(&soup);
    check("a room", shot, true, shot.camera.up.z == 1.0 && shot.shown[3] > 0.0);

    add_box(&soup, point(-1, -1, -1), point(9, 7, 0), false);
    add_lamp(&soup, 3.5, 2.5, 2.8);
    add_box(&soup, point(-1, -1, 3), point(9, 7, 4), false);
    add_box(&soup, point(-1, -1, 0), point(0, 7, 3), false);
    add_box(&soup, point(8, -1, 0), point(9, 7, 3), false);
    add_box(&soup, point(0, -1, 0), point(8, 0, 3), false);
    add_box(&soup, point(0, 6, 0), point(8, 7, 3), false);
    shot = shoot_soup(&soup);
    check("brushes", shot, true, shot.camera.up.z == 1.0 && shot.shown[1] > 0.0);
}

/* Two rooms, of the larger one hardly any light, as links leak some. */
static void test_dark_room(void)
{
    struct soup soup = {0};
    soup_add_box(&soup, ZERO, point(8, 3, 6), 1, true);
    int64_t lit = soup.count;
    soup_add_box(&soup, point(8.1, 0, 0), point(11, 3, 6), 1, true);
    struct world world = world_make(scene_of_soup(&soup));
    struct forest *forest = world.model.forest;
    for (int32_t i = 0; i < world.scene->input_count; i++)
        forest->radiosity[i] = (struct rgb){{0.0, i < lit ? 1e-5 : 0.1, 0.0}};
    struct shot shot = shoot(world, forest);
    check("the lit room of two", shot, true, shot.camera.eye.x > 8.1);
}

static void test_open(void)
{
    struct obj_repairs repairs = {0};
    struct error error = {0};
    struct scene *scene = obj_read("scenes/cornell.obj", &repairs, &error);
    struct shot shot = shoot(world_make(scene), NULL);
    struct vec3 off = vec3_sub(shot.camera.eye, point(278, 273, -800));
    check("the Cornell box, as in its view file", shot, false, vec3_length(off) < 40.0);

    /* A pit in the ground, with a lamp at its bottom; a box on a plain below a sky. */
    struct soup soup = {0};
    add_box(&soup, point(-2, -2, -8), point(2, 2, 0), true);
    soup.ends[0] = soup.count -= 2; /* open */
    soup_add_quad(&soup, point(0, 0, -7.9), point(1, 0, 0), point(0, 1, 0), 1);
    paint(&soup, 0.5, 1.0);
    for (int k = 0; k < 4; k++)
        soup_add_quad(&soup, point(k == 1 ? 2 : -9, k == 3 ? 2 : -9, 0),
                      point(k < 2 ? 7 : 18, 0, 0), point(0, k < 2 ? 18 : 7, 0), 1);
    shot = shoot_soup(&soup);
    check("a pit", shot, true, shot.shown[0] > 0.2);

    add_box(&soup, ZERO, point(5, 4, 6), false);
    soup_add_quad(&soup, point(-99, -99, 0), point(198, 0, 0), point(0, 198, 0), 1);
    paint(&soup, 0.5, 0.0);
    scene = scene_of_soup(&soup);
    add_uniform_sky(scene, 1.0);
    shot = shoot(world_make(scene), NULL);
    check("below a sky", shot, false, shot.shown[0] > 0.05 && shot.shown[2] == 0.0);

    /* Walls and a lamp, no ceiling; a lamp alone; a slim one, far above a floor. */
    add_box(&soup, ZERO, point(12, 9, 2.7), true);
    soup.ends[0] = soup.count -= 2;
    add_lamp(&soup, 2, 4, 2.6);
    shot = shoot_soup(&soup);
    check("a plan", shot, false, shot.camera.up.z == 1.0 && shot.shown[0] > 0.1);
    add_lamp(&soup, 0, 0, 0);
    shot = shoot_soup(&soup);
    check("a lamp alone", shot, false, shot.shown[0] > 0.05);
    soup_add_quad(&soup, ZERO, point(9, 0, 0), point(0, 9, 0), 1);
    paint(&soup, 0.5, 0.0);
    soup_add_quad(&soup, point(1, 4, 9), point(0, 0.01, 0), point(7, 0, 0), 1);
    paint(&soup, 0.5, 1.0);
    shot = shoot_soup(&soup);
    check("a slim lamp", shot, false, shot.camera.up.z == 1.0 && shot.shown[0] > 0.1);
}

int main(void)
{
    test_rooms();
    test_dark_room();
    test_open();
    return tap_done();
}
