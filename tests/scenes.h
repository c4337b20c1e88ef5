/* Small scenes for tests: a growing list of triangles, shapes that are added to it, and
 * the whole of scene, octree, forest and model that is made of it. */
#ifndef TESTS_SCENES_H
#define TESTS_SCENES_H

#include <stdio.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "geom/scene.h"
#include "octree/octree.h"
#include "rad/model.h"
#include "tests/random.h"

/* --- points, at random, too --- */

static inline struct vec3 point(double x, double y, double z)
{
    return (struct vec3){x, y, z};
}

static inline double random_between(struct random *random, double low, double high)
{
    return low + (high - low) * random_unit(random);
}

/* In 0 .. count - 1. */
static inline int32_t random_below(struct random *random, int32_t count)
{
    return (int32_t)(random_bits(random) % (uint64_t)count);
}

/* In the cube around the origin with this half side. */
static inline struct vec3 random_point(struct random *random, double half)
{
    double x = random_between(random, -half, half);
    double y = random_between(random, -half, half);
    return point(x, y, random_between(random, -half, half));
}

/* Inside the triangle, evenly spread. */
static inline struct vec3 random_point_on(struct random *random, const struct triangle *t)
{
    double u = random_unit(random), v = random_unit(random);
    if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    struct vec3 along = vec3_scale(vec3_sub(t->corner[1], t->corner[0]), u);
    struct vec3 across = vec3_scale(vec3_sub(t->corner[2], t->corner[0]), v);
    return vec3_add(t->corner[0], vec3_add(along, across));
}

/* True if corner k of a triangle is this point. */
static inline bool corner_is(const struct scene *scene, int32_t triangle, int k, double x,
                             double y, double z)
{
    return vec3_is_equal(scene->triangles[triangle].corner[k], point(x, y, z));
}

/* A patch of one of the roots 0 .. roots - 1, at any level up to this one. */
static inline struct patch_id random_id(struct random *random, int roots, int max_level)
{
    struct patch_id id = id_of_root((uint32_t)random_below(random, roots));
    for (int level = random_below(random, max_level + 1); level > 0; level--)
        id = id_child(id, random_below(random, 4));
    return id;
}

/* Three points around a random centre, none further away than `size` along an axis. */
static inline struct triangle random_triangle(struct random *random, double half,
                                              double size)
{
    struct vec3 centre = random_point(random, half);
    struct triangle t;
    for (int k = 0; k < 3; k++)
        t.corner[k] = vec3_add(centre, random_point(random, size));
    return t;
}

/* Turned by the quaternion (a, b, c, d), which need not be normalised. */
static inline struct vec3 turned(struct vec3 v, const double q[4])
{
    struct vec3 axis = {q[1], q[2], q[3]};
    double norm = q[0] * q[0] + vec3_dot(axis, axis);
    struct vec3 t = vec3_scale(vec3_cross(axis, v), 2.0 / norm);
    return vec3_add(v, vec3_add(vec3_scale(t, q[0]), vec3_cross(axis, t)));
}

/* The triangle with its front where its back was. */
static inline struct triangle reversed(struct triangle t)
{
    return (struct triangle){{t.corner[0], t.corner[2], t.corner[1]}};
}

/* --- lists of triangles --- */

/* Triangles, each with the material that was given next after it. */
struct soup {
    struct triangle *items; /* [count] */
    int64_t count, capacity;
    struct material materials[64];
    int64_t ends[64]; /* [painted] triangles before it have materials up to this one */
    int painted;
};

static inline void soup_add(struct soup *soup, struct triangle triangle)
{
    RESERVE(soup->items, &soup->capacity, soup->count + 1);
    soup->items[soup->count++] = triangle;
}

static inline void soup_free(struct soup *soup)
{
    alloc_free(soup->items);
    *soup = (struct soup){0};
}

static inline void soup_add_random(struct soup *soup, struct random *random, int count,
                                   double half, double size)
{
    for (int i = 0; i < count; i++)
        soup_add(soup, random_triangle(random, half, size));
}

/* The parallelogram origin, origin + u, origin + u + v, origin + v in n x n cells of two
 * triangles; the front is where u x v points. Cells share the bits of their corners. */
static inline void soup_add_quad(struct soup *soup, struct vec3 origin, struct vec3 u,
                                 struct vec3 v, int n)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            struct vec3 corner[4];
            for (int k = 0; k < 4; k++) {
                struct vec3 along = vec3_scale(u, (double)(i + (k == 1 || k == 2)) / n);
                struct vec3 across = vec3_scale(v, (double)(j + (k >= 2)) / n);
                corner[k] = vec3_add(origin, vec3_add(along, across));
            }
            soup_add(soup, (struct triangle){{corner[0], corner[1], corner[2]}});
            soup_add(soup, (struct triangle){{corner[0], corner[2], corner[3]}});
        }
    }
}

/* The rectangle from `low` to `high`, whose front is in the direction of the sign on the
 * axis where both are equal; nothing if it has no extent. */
static inline void soup_add_rectangle(struct soup *soup, struct vec3 low,
                                      struct vec3 high, int sign)
{
    struct vec3 d = vec3_sub(high, low);
    struct vec3 u = d.x == 0.0 ? point(0, d.y, 0) : d.y == 0.0 ? point(0, 0, d.z)
                                                               : point(d.x, 0, 0);
    struct vec3 v = vec3_sub(d, u);
    if ((d.x == 0.0) + (d.y == 0.0) + (d.z == 0.0) == 1)
        soup_add_quad(soup, low, sign > 0 ? u : v, sign > 0 ? v : u, 1);
}

/* The six sides of a box, n x n cells each; fronts outwards, or inwards for a room. */
static inline void soup_add_box(struct soup *soup, struct vec3 low, struct vec3 high,
                                int n, bool inwards)
{
    struct vec3 size = vec3_sub(high, low);
    struct vec3 edge[3] = {{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}};
    for (int k = 0; k < 3; k++) {
        struct vec3 u = edge[(k + 1) % 3],
                    v = edge[(k + 2) % 3]; /* u x v points along axis k */
        struct vec3 top = vec3_add(low, edge[k]);
        soup_add_quad(soup, low, inwards ? u : v, inwards ? v : u, n);
        soup_add_quad(soup, top, inwards ? v : u, inwards ? u : v, n);
    }
}

/* Splits a triangle of the unit sphere `level` times and adds the parts. Edges are split
 * at the same bits from both sides. */
static inline void soup_add_sphere_part(struct soup *soup, struct triangle t,
                                        double radius, int level)
{
    if (level == 0) {
        for (int k = 0; k < 3; k++)
            t.corner[k] = vec3_scale(t.corner[k], radius);
        soup_add(soup, t);
        return;
    }
    struct vec3 a = t.corner[0], b = t.corner[1], c = t.corner[2];
    struct vec3 ab = vec3_unit(vec3_middle(a, b)), bc = vec3_unit(vec3_middle(b, c)),
                ca = vec3_unit(vec3_middle(c, a));
    soup_add_sphere_part(soup, (struct triangle){{a, ab, ca}}, radius, level - 1);
    soup_add_sphere_part(soup, (struct triangle){{ab, b, bc}}, radius, level - 1);
    soup_add_sphere_part(soup, (struct triangle){{ca, bc, c}}, radius, level - 1);
    soup_add_sphere_part(soup, (struct triangle){{bc, ca, ab}}, radius, level - 1);
}

/* A closed sphere of 8 * 4^level triangles around the origin, fronts outwards. */
static inline void soup_add_sphere(struct soup *soup, double radius, int level)
{
    for (int octant = 0; octant < 8; octant++) {
        double x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1, z = octant & 4 ? -1 : 1;
        struct triangle t = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
        soup_add_sphere_part(soup, x * y * z < 0.0 ? reversed(t) : t, radius, level);
    }
}

/* --- scenes --- */

static inline struct material material_grey(double reflectance, double emission)
{
    return (struct material){.reflectance = {{reflectance, reflectance, reflectance}},
                             .emission = {{emission, emission, emission}}};
}

/* Gives all triangles that have none yet this material. */
static inline void paint_with(struct soup *soup, struct material material)
{
    soup->materials[soup->painted] = material;
    soup->ends[soup->painted++] = soup->count;
}

static inline void paint(struct soup *soup, double reflectance, double emission)
{
    paint_with(soup, material_grey(reflectance, emission));
}

/* The scene of these triangles in input units, not prepared. Those without a material
 * have the first one, which is black if there is none. Empties the soup. */
static inline struct scene *scene_of_soup(struct soup *soup)
{
    int materials = soup->painted > 0 ? soup->painted : 1;
    struct scene *scene = scene_create((int32_t)soup->count, materials);
    for (int32_t i = 0; i < scene->input_count; i++)
        scene->triangles[i] = soup->items[i];
    for (int32_t m = 0, i = 0; m < soup->painted; m++) {
        scene->materials[m] = soup->materials[m];
        for (; i < soup->ends[m]; i++)
            scene->material_of[i] = m;
    }
    soup_free(soup);
    return scene;
}

/* scene_prepare() for a scene that is known to be right. Returns it. */
static inline struct scene *prepared(struct scene *scene)
{
    struct scene_repairs repairs;
    struct error reason = {0};
    if (!scene_prepare(scene, &repairs, &reason)) {
        printf("Bail out! %s\n", reason.text);
        exit(1);
    }
    return scene;
}

static inline struct octree *octree_of(const struct scene *scene)
{
    return octree_create(scene->triangles, scene_blocking_planes(scene),
                         scene->input_count);
}

struct world {
    struct scene *scene;
    struct octree *octree;
    struct model model; /* model.forest is the forest */
};

/* Prepares and owns the scene, and makes the rest by a criterion that a test may
 * change. */
static inline struct world world_make(struct scene *scene)
{
    static const struct criterion criterion = {.epsilon = 1e-3, .max_level = ID_MAX_LEVEL,
                                               .tolerance = 1e-3, .max_iterations = 1};
    struct world world = {.scene = prepared(scene)};
    world.octree = octree_of(scene);
    world.model =
        model_make(scene, world.octree, forest_create(scene), &criterion, PAPER);
    return world;
}

static inline void world_free(struct world *world)
{
    forest_destroy(world->model.forest);
    octree_destroy(world->octree);
    scene_destroy(world->scene);
}

static inline void set_randomly(struct forest *forest, struct random *random)
{
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            forest->radiosity[p].band[c] = random_unit(random);
}

static inline void clear_flux(struct forest *forest)
{
    for (int64_t p = 0; p < forest->count; p++)
        for (int c = 0; c < BANDS; c++)
            forest->patches[p].flux[c] = 0;
}

/* --- answers by brute force --- */

/* The first of the triangles that blocks the segment, `own` left out, or -1. */
static inline int32_t brute_blocker(const struct triangle *triangles,
                                    const struct plane *planes, int32_t count,
                                    struct vec3 from, struct vec3 to,
                                    const int32_t own[2])
{
    struct segment segment = segment_make(from, to);
    for (int32_t i = 0; i < count; i++)
        if (i != own[0] && i != own[1] &&
            vec3_dot(planes[i].normal, planes[i].normal) > 0.0 &&
            segment_is_blocked_by(&segment, &triangles[i], &planes[i]))
            return i;
    return -1;
}

#endif
