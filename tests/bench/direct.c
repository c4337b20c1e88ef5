/* Makes the truth about a scene that has direct light only, in closed form: a file like
 * that of tests/bench/reference.c, without noise.
 *
 *   make chart, or  build/mpi/direct scenes/shadow.obj shadow.ref [ELEMENTS]
 *
 * The scene: a floor that reflects, in one plane; above it black screens, in a plane
 * parallel to it; above those, black lamps. A point x of the floor then has
 *
 *     rho H(x) = rho  sum over lamps of  E (F(x, lamp) - hidden(x, lamp)),
 *     hidden(x, lamp) = sum over screens of F(x, lamp behind screen),
 *
 * where F is Lambert's form factor (geom/lambert.h), and the part of a lamp behind a
 * triangle is the lamp cut by the three planes through x and the triangle's edges.
 * Triangles of one plane hide different parts, so nothing is taken away twice.
 *
 * The mean over an element is Radon's rule of seven points, on quarters of quarters,
 * until the four quarters agree with the whole; the limit is that of the worst element,
 * CLOSE times the light of a hemisphere filled by the lamp. Both halves of the truth are
 * the same, and its points are those that reference.c has, from truth_find_point() with
 * one path. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geom/lambert.h"
#include "tests/reading.h"
#include "tests/truth.h"

/* A triangle cut by three planes has at most six corners. */
enum { ELEMENTS = 20000, CORNERS = 6, DEEPEST = 8 };

static const double CLOSE = 1e-8;

struct sector {
    struct vec3 corner[CORNERS];
    int count;
};

/* Keeps the part of the polygon with dot(normal, y - x) >= 0. */
static struct sector cut(const struct sector *whole, struct vec3 x, struct vec3 normal)
{
    struct sector rest = {.count = 0};
    for (int k = 0; k < whole->count; k++) {
        struct vec3 from = whole->corner[k], to = whole->corner[(k + 1) % whole->count];
        double before = vec3_dot(normal, vec3_sub(from, x));
        double after = vec3_dot(normal, vec3_sub(to, x));
        if (before >= 0.0 && rest.count < CORNERS)
            rest.corner[rest.count++] = from;
        if ((before < 0.0) != (after < 0.0) && before != 0.0 && rest.count < CORNERS) {
            struct vec3 along = vec3_scale(vec3_sub(to, from), before / (before - after));
            rest.corner[rest.count++] = vec3_add(from, along);
        }
    }
    return rest;
}

/* The part of the lamp behind the screen, as seen from x. */
static struct sector hidden_part(const struct triangle *lamp,
                                 const struct triangle *screen, struct vec3 x)
{
    struct sector part = {{lamp->corner[0], lamp->corner[1], lamp->corner[2]}, 3};
    struct vec3 a = vec3_sub(screen->corner[0], x), b = vec3_sub(screen->corner[1], x);
    struct vec3 c = vec3_sub(screen->corner[2], x);
    double turn = vec3_dot(vec3_cross(a, b), c) < 0.0 ? -1.0 : 1.0;
    part = cut(&part, x, vec3_scale(vec3_cross(a, b), turn));
    part = cut(&part, x, vec3_scale(vec3_cross(b, c), turn));
    return cut(&part, x, vec3_scale(vec3_cross(c, a), turn));
}

static double visible_factor(const struct scene *scene, const struct triangle *lamp,
                             struct vec3 x, struct vec3 normal)
{
    double factor = point_triangle_factor(x, normal, lamp);
    for (int32_t root = 0; root < scene->input_count; root++) {
        if (!material_is_dark(scene_root_material(scene, root)))
            continue;
        struct sector part = hidden_part(lamp, &scene->triangles[root], x);
        if (part.count >= 3)
            factor -= point_polygon_factor(x, normal, part.corner, part.count);
    }
    return fmax(factor, 0.0);
}

/* Irradiance, W/m^2, at a point of a root. */
static struct rgb irradiance_at(const struct scene *scene, int32_t floor, struct vec3 x)
{
    struct rgb sum = {{0.0, 0.0, 0.0}};
    for (int32_t root = 0; root < scene->input_count; root++) {
        struct rgb emission = scene_root_material(scene, root)->emission;
        if (!(rgb_sum(emission) > 0.0))
            continue;
        double factor = visible_factor(scene, &scene->triangles[root], x,
                                       scene->planes[floor].normal);
        for (int c = 0; c < BANDS; c++)
            sum.band[c] += emission.band[c] * factor;
    }
    return sum;
}

/* The point of barycentric coordinates a, a and 1 - 2 a, the last one at corner k. */
static struct vec3 point_beside(const struct triangle *t, int k, double a)
{
    struct vec3 sides = vec3_add(t->corner[(k + 1) % 3], t->corner[(k + 2) % 3]);
    return vec3_add(vec3_scale(sides, a), vec3_scale(t->corner[k], 1.0 - 2.0 * a));
}

/* Mean irradiance over a triangle by Radon's rule, exact to degree 5. */
static struct rgb mean_by_points(const struct scene *scene, int32_t root,
                                 const struct triangle *t)
{
    static const double PLACE[2] = {0.10128650732345634, 0.4701420641051151};
    static const double WEIGHT[2] = {0.12593918054482714, 0.1323941527885062};
    struct rgb mean = irradiance_at(scene, root, point_beside(t, 0, 1.0 / 3.0));
    for (int c = 0; c < BANDS; c++)
        mean.band[c] *= 0.225;
    for (int k = 0; k < 6; k++) {
        struct rgb h = irradiance_at(scene, root, point_beside(t, k % 3, PLACE[k / 3]));
        for (int c = 0; c < BANDS; c++)
            mean.band[c] += WEIGHT[k / 3] * h.band[c];
    }
    return mean;
}

/* Mean irradiance over a triangle, to `limit` W/m^2; `whole` is that by seven points. */
static struct rgb mean_over(const struct scene *scene, int32_t root,
                            const struct triangle *t, struct rgb whole, double limit,
                            int level)
{
    struct triangle child[4];
    struct rgb part[4], mean = {{0.0, 0.0, 0.0}};
    double difference = 0.0;
    for (int k = 0; k < 4; k++) {
        child[k] = triangle_child(t, k);
        part[k] = mean_by_points(scene, root, &child[k]);
        for (int c = 0; c < BANDS; c++)
            mean.band[c] += 0.25 * part[k].band[c];
    }
    for (int c = 0; c < BANDS; c++)
        difference = fmax(difference, fabs(mean.band[c] - whole.band[c]));
    if (difference <= limit || level == DEEPEST)
        return mean;
    mean = (struct rgb){{0.0, 0.0, 0.0}};
    for (int k = 0; k < 4; k++) {
        struct rgb fine = mean_over(scene, root, &child[k], part[k], limit, level + 1);
        for (int c = 0; c < BANDS; c++)
            mean.band[c] += 0.25 * fine.band[c];
    }
    return mean;
}

/* --- elements --- */

static struct rgb reflected(const struct scene *scene, int32_t root,
                            struct rgb irradiance)
{
    for (int c = 0; c < BANDS; c++)
        irradiance.band[c] *= scene_root_material(scene, root)->reflectance.band[c];
    return irradiance;
}

static void find_element(const struct scene *scene, struct element *element, double limit)
{
    int32_t root = (int32_t)element->id.root;
    struct triangle whole = scene->triangles[root], part = whole;
    for (int step = 0; step < id_level(element->id); step++)
        part = triangle_child(&part, id_step(element->id, step));
    struct vec3 weight = {element->weight[0], element->weight[1], element->weight[2]};
    struct vec3 x = corners_mean(whole.corner, weight);
    struct rgb mean =
        mean_over(scene, root, &part, mean_by_points(scene, root, &part), limit, 0);
    for (int half = 0; half < TRUTH_HALVES; half++) {
        element->mean[half] = reflected(scene, root, mean);
        element->point[half] = reflected(scene, root, irradiance_at(scene, root, x));
    }
}

static void make_truth(const struct scene *scene, struct truth *truth)
{
    struct octree *octree =
        octree_create(scene->triangles, scene_blocking_planes(scene),
                      scene->input_count);
    struct pathtracer pathtracer = pathtracer_make(scene, octree);
    double brightest = 0.0;
    for (int32_t m = 0; m < scene->material_count; m++)
        brightest = fmax(brightest, rgb_sum(scene->materials[m].emission));
    for (int64_t i = 0; i < truth->count; i++) {
        truth_find_point(truth, i, &pathtracer, 1);
        find_element(scene, &truth->items[i], CLOSE * brightest);
    }
    pathtracer_free(&pathtracer);
    octree_destroy(octree);
}

/* --- scenes of the formula --- */

/* Extends low..high to the heights of a root over the floor's plane. */
static void extend(const struct plane *floor, const struct triangle *t, double *low,
                   double *high)
{
    for (int k = 0; k < 3; k++) {
        double height = plane_distance(floor, t->corner[k]);
        *low = fmin(*low, height);
        *high = fmax(*high, height);
    }
}

static bool check_scene(const struct scene *scene, struct error *error)
{
    enum { FLOOR, SCREEN, LAMP, KINDS };
    double low[KINDS] = {1.0, 1.0, 1.0}, high[KINDS] = {-1.0, -1.0, -1.0};
    const struct plane *floor = NULL;
    bool mixed = false;
    for (int32_t root = 0; root < scene->input_count; root++)
        if (rgb_sum(scene_root_material(scene, root)->reflectance) > 0.0)
            floor = &scene->planes[root];
    for (int32_t root = 0; floor && root < scene->input_count; root++) {
        const struct material *material = scene_root_material(scene, root);
        bool lamp = rgb_sum(material->emission) > 0.0, dark = material_is_dark(material);
        int kind = lamp ? LAMP : dark ? SCREEN : FLOOR;
        mixed = mixed || (lamp && rgb_sum(material->reflectance) > 0.0);
        extend(floor, &scene->triangles[root], &low[kind], &high[kind]);
    }
    bool layered =
        high[FLOOR] < low[SCREEN] && high[FLOOR] < low[LAMP] && high[SCREEN] < low[LAMP];
    bool flat = high[FLOOR] - low[FLOOR] < 1e-12 && high[SCREEN] - low[SCREEN] < 1e-12;
    return (floor && !mixed && layered && flat) ||
           error_set(error, EXIT_USAGE,
                     "not a floor, black screens over it, black lamps over them");
}

int main(int argc, char **argv)
{
    struct comm comm;
    struct error error = {0};
    long long elements = argc > 3 ? atoll(argv[3]) : ELEMENTS;
    comm_start(&comm, &argc, &argv);
    struct scene *scene = NULL;
    if (argc < 3 || elements < 1)
        error_set(&error, EXIT_USAGE, "usage: direct SCENE.obj OUT.ref [ELEMENTS]");
    else
        scene = scene_read((struct reading){.path = argv[1]}, &error);
    if (scene && check_scene(scene, &error)) {
        double start = comm_seconds();
        struct truth truth = truth_make(scene, elements);
        make_truth(scene, &truth);
        if (truth_write(&truth, argv[2], &error))
            printf("%s: %lld elements in closed form, %.1f s\n", argv[2],
                   (long long)truth.count, comm_seconds() - start);
        truth_free(&truth);
    }
    if (error.code != EXIT_DONE)
        fprintf(stderr, "direct: %s\n", error.text);
    scene_destroy(scene);
    comm_stop(&comm);
    return error.code;
}
