/* Smooth surfaces: roots joined over common edges.
 *
 * All edges of all roots are sorted, so equal edges (the same end points, to the bit) are
 * neighbours; roots on both sides of a smooth edge are joined (union-find).
 *
 * Triangles with normals at their corners may stand for a curved surface: an edge is
 * smooth if the normals agree at both of its ends. Normals are turned to the front, so a
 * front never goes on in a back. Roots joined at one edge are one surface everywhere: a
 * crease ending inside a smooth surface is lost, since telling its two sides apart would
 * take a number for each corner and each edge of a root. */
#include "io/picture/surface.h"

#include <stddef.h>
#include <stdlib.h>

#include "geom/alloc.h"

/* Directions agree within 2.5 degrees. */
static const double SMOOTH_COSINE = 0.999;

struct root_edge {
    struct vec3 low, high; /* end points, in lexical order */
    int32_t root;
    int8_t low_corner, high_corner; /* corners of the root at low and high, 0 to 2 */
};

static int compare_edges(const void *left, const void *right)
{
    const struct root_edge *a = left, *b = right;
    int order = vec3_compare(a->low, b->low);
    order = order ? order : vec3_compare(a->high, b->high);
    return order ? order : (a->root > b->root) - (a->root < b->root);
}

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

/* True if the surface is smooth over the common edge of two roots. */
static bool is_smooth(const struct scene *scene, const struct root_edge *a,
                      const struct root_edge *b)
{
    if (scene_root_material(scene, a->root) != scene_root_material(scene, b->root))
        return false;
    struct plane plane_a = scene_root_plane(scene, a->root);
    struct plane plane_b = scene_root_plane(scene, b->root);
    return vec3_dot(plane_a.normal, plane_b.normal) >= SMOOTH_COSINE ||
           (normals_agree(scene, a->root, a->low_corner, b->root, b->low_corner) &&
            normals_agree(scene, a->root, a->high_corner, b->root, b->high_corner));
}

int32_t *surface_of_roots(const struct scene *scene)
{
    int32_t roots = scene_root_count(scene);
    int32_t *surface = alloc_array((size_t)roots, sizeof *surface);
    struct root_edge *edges = alloc_array(3 * (size_t)roots, sizeof *edges);
    size_t count = 0;
    for (int32_t root = 0; root < roots; root++) {
        struct triangle t = scene_root_triangle(scene, root);
        surface[root] = root;
        for (int k = 0; k < 3 && scene_root_area(scene, root) > 0.0; k++) {
            int next = (k + 1) % 3;
            bool ordered = vec3_compare(t.corner[k], t.corner[next]) <= 0;
            int low = ordered ? k : next, high = ordered ? next : k;
            edges[count++] = (struct root_edge){t.corner[low], t.corner[high], root,
                                                (int8_t)low, (int8_t)high};
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1;
             j < count && vec3_is_equal(edges[i].low, edges[j].low) &&
             vec3_is_equal(edges[i].high, edges[j].high);
             j++)
            if (is_smooth(scene, &edges[i], &edges[j]))
                surface[first_of(surface, edges[i].root)] =
                    first_of(surface, edges[j].root);
    }
    for (int32_t root = 0; root < roots; root++)
        surface[root] = first_of(surface, root);
    alloc_free(edges);
    return surface;
}
