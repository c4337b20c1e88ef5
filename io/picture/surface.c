/* Smooth surfaces: roots joined over common edges.
 *
 * Roots on both sides of a smooth edge (the same end points, to the bit) are joined
 * (union-find).
 *
 * Triangles with normals at their corners may stand for a curved surface: an edge is
 * smooth if the normals agree at both of its ends. Normals are turned to the front, so a
 * front never goes on in a back. Roots joined at one edge are one surface everywhere: a
 * crease ending inside a smooth surface is lost, since telling its two sides apart would
 * take a number for each corner and each edge of a root. */
#include "io/picture/surface.h"

#include <stdbool.h>

#include "geom/alloc.h"
#include "geom/side.h"

/* Directions agree within 2.5 degrees. */
static const double SMOOTH_COSINE = 0.999;

static int32_t first_of(int32_t *surface, int32_t root)
{
    while (surface[root] != root)
        root = surface[root] = surface[surface[root]];
    return root;
}

static bool normals_agree(const struct scene *scene, int32_t a, int corner_a, int32_t b,
                          int corner_b)
{
    return vec3_dot(scene_root_normal(scene, a, corner_a),
                    scene_root_normal(scene, b, corner_b)) >= SMOOTH_COSINE;
}

/* True if the surface is smooth over the common edge of two roots, a side of each. */
static bool is_smooth(const struct scene *scene, const struct triangle *roots, int32_t s,
                      int32_t t)
{
    int32_t a = s / 3, b = t / 3;
    if (scene_root_material(scene, a) != scene_root_material(scene, b))
        return false;
    struct plane plane_a = scene_root_plane(scene, a);
    struct plane plane_b = scene_root_plane(scene, b);
    bool along = vec3_is_equal(side_start(roots, s), side_start(roots, t));
    int from = along ? t % 3 : (t + 1) % 3, to = along ? (t + 1) % 3 : t % 3;
    return vec3_dot(plane_a.normal, plane_b.normal) >= SMOOTH_COSINE ||
           (normals_agree(scene, a, s % 3, b, from) &&
            normals_agree(scene, a, (s + 1) % 3, b, to));
}

int32_t *surface_of_roots(const struct scene *scene)
{
    int32_t count = scene_root_count(scene);
    int32_t *surface = alloc_array((size_t)count, sizeof *surface);
    struct triangle *roots = alloc_array((size_t)count, sizeof *roots);
    for (int32_t root = 0; root < count; root++) {
        surface[root] = root;
        roots[root] = scene_root_triangle(scene, root);
    }
    int32_t *same = sides_match(roots, count);
    for (int32_t s = 0; s < 3 * count; s++)
        for (int32_t t = same[s]; t >= 0; t = same[t])
            if (scene_root_area(scene, s / 3) > 0.0 &&
                scene_root_area(scene, t / 3) > 0.0 && is_smooth(scene, roots, s, t))
                surface[first_of(surface, s / 3)] = first_of(surface, t / 3);
    for (int32_t root = 0; root < count; root++)
        surface[root] = first_of(surface, root);
    alloc_free(same);
    alloc_free(roots);
    return surface;
}
