/* Tests of io/scene/camera.h. Proved are: the meaning of a view file and the number of a
 * wrong line; that rays make the angles that trigonometry says; and that a camera that
 * frames a scene has all of it in its picture, and little more. */
#include "io/scene/camera.h"

#include <math.h>
#include <stdio.h>

#include "tests/load.h"
#include "tests/refusal.h"
#include "tests/scenes.h"

#define VIEW "build/camera_test.view"
#define PLACE "eye 0 0 5\nat 0 0 0\n" /* two lines that every view needs */

static bool read_view(const char *text, struct camera *camera)
{
    forget_error();
    write_text(VIEW, text);
    return camera_read(VIEW, camera, &error);
}

static bool is_point(struct vec3 x, double a, double b, double c)
{
    return x.x == a && x.y == b && x.z == c;
}

/* --- view files --- */

static void test_keywords(void)
{
    struct camera camera;
    tap_ok(read_view("# all\r\nsize 640 480 # pixels\n\nup 0 0 2\n  fov 30.5\nat 1 -2 3\n"
                     "eye 4 \\\n5e-1 -6\n",
                     &camera) &&
               is_point(camera.eye, 4, 0.5, -6) && is_point(camera.at, 1, -2, 3) &&
               is_point(camera.up, 0, 0, 2) && camera.fov == 30.5 &&
               camera.width == 640 && camera.height == 480 && !camera.fronts_only,
           "all keywords, in any order, with comments");
    tap_ok(read_view(PLACE, &camera) && is_point(camera.eye, 0, 0, 5) &&
               is_point(camera.at, 0, 0, 0) && is_point(camera.up, 0, 1, 0) &&
               camera.fov == 45.0 && camera.width == 512 && camera.height == 512,
           "defaults");
    tap_ok(read_view("eye 0 9 0\nat 0 1 0\n", &camera) && is_point(camera.up, 0, 0, 1),
           "looking along the default up, up is z");
    tap_ok(read_view("eye 0 0 1e100\nat 0 0 0\nup 1e100 1e100 0\n", &camera) &&
               fabs(vec3_length(camera_ray(&camera, 256.0, 256.0)) - 1.0) < 1e-15 &&
               vec3_length(camera_ray(&camera, 0.0, 0.0)) < 2.0,
           "extreme coordinates");
}

static void check_refused(const char *text, const char *message)
{
    struct camera camera;
    check_error(read_view(text, &camera), message);
}

static void test_bad_lines(void)
{
    check_refused(PLACE "up\n", VIEW ":3: 3 numbers are needed");
    check_refused(PLACE "fov\n", VIEW ":3: 1 number is needed");
    check_refused(PLACE "\nsize 5\n", VIEW ":4: 2 numbers are needed");
    check_refused(PLACE "at 1 2 3 4\n", VIEW ":3: unexpected '4'");
    check_refused("eye 0 0 5\r\nat 0 0 0x1\r\n", VIEW ":2: bad number '0x1'");
    check_refused("eye 0 0 \\\n1e101\n", VIEW ":1: number '1e101' is out of range");
    check_refused("# c\n\nEye 0 0 0\n", VIEW ":3: unknown keyword 'Eye'");
}

static void test_bad_values(void)
{
    static const char *const fovs[] = {"0", "-1", "180"};
    static const char *const sizes[] = {"0 5", "5 0", "5.5 5", "5 32769"};
    char text[100];
    for (size_t i = 0; i < sizeof fovs / sizeof fovs[0]; i++) {
        snprintf(text, sizeof text, PLACE "fov %s\n", fovs[i]);
        check_refused(text, VIEW ":3: fov must lie between 0 and 180 degrees");
    }
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        snprintf(text, sizeof text, PLACE "\n\nsize %s\n", sizes[i]);
        check_refused(text, VIEW ":5: a size is a whole number from 1 to 32768");
    }
}

/* Errors of the file as a whole name no line. */
static void test_bad_views(void)
{
    check_refused("", VIEW ": no 'eye' line");
    check_refused("eye 1 2 3\n", VIEW ": no 'at' line");
    check_refused("eye 1 2 3\nat 1 2 3\n", VIEW ": eye and at are the same point");
    check_refused("up 0 1 0\neye 0 9 0\nat 0 1 0\n",
                  VIEW ": up points along the viewing direction");
    check_refused(PLACE "up 0 0 0\n", VIEW ": up points along the viewing direction");
}

/* --- rays --- */

/* A ray as (right, up) per unit of forward, in the frame of a camera at (0, 0, 5) that
 * looks along -z: right is x and up is y. */
static struct vec3 slope(const struct camera *camera, double x, double y)
{
    struct vec3 ray = camera_ray(camera, x, y);
    return point(ray.x / -ray.z, ray.y / -ray.z, 0.0);
}

/* 1e-14 is about 60 roundings; the tangent is as wrong as its angle times 1 + tan^2. */
static bool is_tangent(double found, double angle)
{
    double t = tan(angle);
    return fabs(found - t) <= 1e-14 * (1.0 + t * t);
}

static void check_angles(struct camera *camera, double fov, int width, int height)
{
    double half = fov * PI / 360.0, aspect = (double)width / height;
    camera->fov = fov;
    camera->width = width;
    camera->height = height;
    struct vec3 middle = slope(camera, 0.5 * width, 0.5 * height);
    struct vec3 top = slope(camera, 0.5 * width, 0.0),
                bottom = slope(camera, 0.5 * width, height);
    struct vec3 left = slope(camera, 0.0, 0.5 * height),
                right = slope(camera, width, 0.5 * height);
    tap_ok(is_point(middle, 0.0, 0.0, 0.0) && is_tangent(top.y, half) &&
               is_tangent(-bottom.y, half) && top.x == 0.0 && bottom.x == 0.0,
           "%g degrees, %d x %d: up and down", fov, width, height);
    tap_ok(is_tangent(right.x / aspect, half) && is_tangent(-left.x / aspect, half) &&
               left.y == 0.0 && right.y == 0.0,
           "%g degrees, %d x %d: left and right", fov, width, height);
}

static void test_angles(void)
{
    static const double fovs[] = {0.001, 1.0, 45.0, 90.0, 150.0, 179.0};
    struct camera camera;
    read_view(PLACE, &camera);
    for (size_t i = 0; i < sizeof fovs / sizeof fovs[0]; i++)
        check_angles(&camera, fovs[i], 512, 512);
    check_angles(&camera, 40.0, 800, 400);
    check_angles(&camera, 40.0, 32768, 3);
}

/* Any camera: the centre ray goes to `at`, the one above it lies in the plane of `up`. */
static void test_directions(void)
{
    struct random random = random_seed(5);
    struct camera camera = {.fov = 50.0, .width = 300, .height = 200};
    int right = 0;
    for (int i = 0; i < 1000; i++) {
        camera.eye = random_point(&random, 0.5);
        camera.at = random_point(&random, 0.5);
        camera.up = random_point(&random, 0.5);
        struct vec3 forward = vec3_sub(camera.at, camera.eye);
        struct vec3 side = vec3_cross(forward, camera.up);
        struct vec3 middle = camera_ray(&camera, 150.0, 100.0);
        struct vec3 top = camera_ray(&camera, 150.0, 0.0);
        double size = vec3_length(forward);
        double sine = vec3_length(side) / (size * vec3_length(camera.up));
        right += fabs(vec3_dot(middle, forward) / size - 1.0) < 1e-14 &&
                 vec3_length(vec3_cross(middle, forward)) < 1e-14 * size &&
                 fabs(vec3_dot(top, side)) < 1e-14 / sine * vec3_length(side) &&
                 vec3_dot(top, camera.up) > vec3_dot(middle, camera.up);
    }
    tap_ok(right == 1000, "1000 cameras look at `at` with `up` above (%d)", right);
}

/* --- a camera that frames a scene --- */

/* Whether the point is in front of the camera and in its picture. Solves
 * point - eye = depth * middle + across * (one pixel right) + down * (one pixel down). */
static bool camera_sees(const struct camera *camera, struct vec3 point)
{
    double x = 0.5 * camera->width, y = 0.5 * camera->height;
    struct vec3 middle = camera_ray(camera, x, y), to = vec3_sub(point, camera->eye);
    struct vec3 pixel = vec3_sub(camera_ray(camera, x + 1.0, y), middle);
    struct vec3 line = vec3_sub(camera_ray(camera, x, y + 1.0), middle);
    double depth = vec3_dot(to, middle) / vec3_dot(middle, middle);
    double across = vec3_dot(to, pixel) / vec3_dot(pixel, pixel) / depth;
    double down = vec3_dot(to, line) / vec3_dot(line, line) / depth;
    return depth > 0.0 && fabs(across) <= x && fabs(down) <= y;
}

/* A scene that is one triangle with the bounding box `low`, `high`. */
static struct scene *make_scene(struct vec3 low, struct vec3 high)
{
    struct soup soup = {0};
    struct vec3 b = {high.x, low.y, high.z}, c = {high.x, high.y, low.z};
    soup_add(&soup, (struct triangle){{low, b, c}});
    return prepared(scene_of_soup(&soup));
}

/* Whether a camera in the direction `towards` has the whole box in its picture, and one a
 * fifth nearer has not. */
static bool box_is_framed(struct vec3 low, struct vec3 high, struct vec3 towards)
{
    struct scene *scene = make_scene(low, high);
    struct camera camera = {
        .up = {0.0, 1.0, 0.0}, .fov = 40.0, .width = 150, .height = 400};
    struct subject subject = subject_find(scene);
    camera_frame(&camera, scene, &subject, towards);
    struct camera nearer = camera;
    nearer.eye = vec3_add(vec3_scale(camera.eye, 0.8), vec3_scale(camera.at, 0.2));
    bool seen = true, near_sees = true;
    for (int k = 0; k < 8; k++) {
        struct vec3 corner = {k & 1 ? low.x : high.x, k & 2 ? low.y : high.y,
                              k & 4 ? low.z : high.z};
        seen = seen && camera_sees(&camera, corner);
        near_sees = near_sees && camera_sees(&nearer, corner);
    }
    struct vec3 eye = camera.eye;
    bool inside = eye.x >= low.x && eye.x <= high.x && eye.y >= low.y &&
                  eye.y <= high.y && eye.z >= low.z && eye.z <= high.z;
    scene_destroy(scene);
    return seen && !near_sees && !inside;
}

static void check_box(const char *name, struct vec3 low, struct vec3 high)
{
    tap_ok(box_is_framed(low, high, point(0.4, 0.35, 1)) &&
               box_is_framed(low, high, point(0, 0, -1)),
           "all corners are seen: %s", name);
}

static void test_boxes(void)
{
    struct vec3 zero = {0.0, 0.0, 0.0};
    check_box("a plate", zero, point(8, 0, 5));
    check_box("a wall", zero, point(0, 3, 5));
    check_box("far from the origin", point(1e6, -3e6, 5e5),
              point(1e6 + 1.0, -3e6 + 2.0, 5e5 + 3.0));
    check_box("small", zero, point(1e-9, 2e-9, 1e-9));
    check_box("large", point(-1e9, -1e9, -1e9), point(1e9, 1e9, 1e9));
    /* half its diagonal is the way from `at` straight up to the edge of the picture */
    check_box("a leaning pole", zero, point(0.0099, 0.9996, 0.028));
}

static void test_many_boxes(void)
{
    struct random random = random_seed(8);
    int seen = 0;
    for (int i = 0; i < 20000; i++) {
        struct vec3 low = random_point(&random, 0.5), size = random_point(&random, 0.5);
        struct vec3 high = {low.x + fabs(size.x) * pow(10.0, i % 4), low.y + fabs(size.y),
                            low.z + fabs(size.z) * pow(10.0, -(i % 3))};
        struct vec3 towards = random_point(&random, 0.5);
        towards.y *= 0.9 * (fabs(towards.x) + fabs(towards.z)); /* not along up */
        seen += box_is_framed(low, high, towards);
    }
    tap_ok(seen == 20000, "all corners of %d of 20000 boxes are seen", seen);
}

int main(void)
{
    test_keywords();
    test_bad_lines();
    test_bad_values();
    test_bad_views();
    test_angles();
    test_directions();
    test_boxes();
    test_many_boxes();
    remove(VIEW);
    return tap_done();
}
