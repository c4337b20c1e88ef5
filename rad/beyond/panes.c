/* Panes.
 *
 * Few rays find a window by chance, and each brings much light; so a receiver aims at
 * panes. A segment to a point of a pane goes on to sky, ground or the next room behind.
 * Rays that cross the pane by chance are put aside (gather/rays.c). Where several panes
 * are on the way, the first one aimed at brings the light. Light crossing panes is
 * multiplied by the transmittance of each; light reflected by a pane is added.
 *
 * A pane has a root on each side, with d times its reflectance. It blocks nothing, so its
 * rows are those of two leaves back to back. Of a face modelled from both sides each is
 * met on its front alone, and the two count as one pane. */
#include "rad/beyond/panes.h"

#include "geom/alloc.h"
#include "geom/hash.h"
#include "rad/beyond/sample.h"

enum { LOOKS = 64 }; /* rays from a side of a pane, to find its light */

struct panes *panes_create(const struct scene *scene)
{
    if (!scene->has_panes)
        return NULL;
    struct panes *panes = alloc_array(1, sizeof *panes);
    size_t most = (size_t)scene->input_count;
    panes->scene = scene;
    panes->inputs = alloc_array(most, sizeof *panes->inputs);
    panes->triangles = alloc_array(most, sizeof *panes->triangles);
    panes->planes = alloc_array(most, sizeof *panes->planes);
    for (int32_t i = 0; i < scene->input_count; i++) {
        if (!material_is_pane(scene_root_material(scene, i)) || !(scene->areas[i] > 0.0))
            continue;
        panes->inputs[panes->count] = i;
        panes->triangles[panes->count] = scene->triangles[i];
        panes->planes[panes->count++] = scene->planes[i];
    }
    panes->octree = octree_create(panes->triangles, panes->planes, panes->count);
    return panes;
}

void panes_destroy(struct panes *panes)
{
    if (!panes)
        return;
    octree_destroy(panes->octree);
    alloc_free(panes->inputs);
    alloc_free(panes->triangles);
    alloc_free(panes->planes);
    alloc_free(panes->sent);
    alloc_free(panes);
}

struct pane_walk pane_walk_to(struct vec3 from, struct vec3 to)
{
    struct vec3 way = vec3_sub(to, from);
    return (struct pane_walk){from, vec3_unit(way), vec3_length(way), -1};
}

bool panes_next(const struct panes *panes, struct pane_walk *walk,
                struct octree_counts *counts)
{
    struct octree_hit hit;
    while (walk->left > 0.0 && octree_first_hit(panes->octree, walk->at, walk->direction,
                                                false, &hit, counts)) {
        struct plane plane = panes->planes[hit.triangle];
        double along = plane_ahead(&plane, walk->at, walk->direction);
        struct vec3 beyond = vec3_scale(plane.normal, hit.front ? -1.0 : 1.0);
        if (!(along <= walk->left))
            return false;
        walk->left -= along;
        walk->at = point_above(vec3_add(walk->at, vec3_scale(walk->direction, along)),
                               beyond);
        walk->root = scene_root_on(panes->scene, panes->inputs[hit.triangle], hit.front);
        if (walk->root >= 0)
            return true;
    }
    return false;
}

void pane_filter(const struct scene *scene, int32_t root, struct rgb *light)
{
    *light = rgb_times(*light, scene_root_material(scene, root)->transmittance);
}

void panes_filter(const struct panes *panes, struct pane_walk walk, struct rgb *light,
                  struct octree_counts *counts)
{
    while (panes && panes_next(panes, &walk, counts))
        pane_filter(panes->scene, walk.root, light);
}

void panes_cross(const struct panes *panes, struct pane_walk walk,
                 const struct forest *forest, struct rgb *share, struct rgb *light,
                 struct octree_counts *counts)
{
    while (panes && panes_next(panes, &walk, counts)) {
        double weight[3];
        int32_t leaf = leaf_under(forest, walk.root, walk.at, weight);
        rgb_add(light, 1.0, rgb_times(*share, forest->radiosity[leaf]));
        pane_filter(panes->scene, walk.root, share);
    }
}

bool panes_put_aside(const struct panes *panes, struct pane_walk walk, int32_t but,
                     struct octree_counts *counts)
{
    while (panes_next(panes, &walk, counts))
        if (walk.root != but && rgb_sum(panes->sent[walk.root]) > 0.0)
            return true;
    return false;
}

/* The mean radiosity seen from the front of a pane's root, or, if `side` is -1, from its
 * back, through the pane. */
static struct rgb seen_through(const struct panes *panes, const struct octree *octree,
                               const struct forest *forest, int32_t root, double side)
{
    const struct scene *scene = panes->scene;
    struct triangle t = scene_root_triangle(scene, root);
    struct vec3 normal = vec3_scale(scene_root_plane(scene, root).normal, side);
    uint64_t seed = hash_mix((uint64_t)root);
    struct rgb sum = {{0.0, 0.0, 0.0}};
    struct octree_counts counts = {0};
    for (int i = 0; i < LOOKS; i++, seed = hash_mix(seed)) {
        struct half_line ray = ray_sample(&t, normal, seed, i, LOOKS);
        int32_t met = root_met(scene, octree, &ray, -1, &counts);
        if (met >= 0)
            rgb_add(&sum, 1.0 / LOOKS, forest->radiosity[met]);
    }
    pane_filter(scene, root, &sum);
    return sum;
}

void panes_look(struct panes *panes, const struct octree *octree,
                const struct forest *forest)
{
    const struct scene *scene = panes->scene;
    alloc_free(panes->sent);
    panes->sent = alloc_array((size_t)scene_root_count(scene), sizeof *panes->sent);
    for (int32_t i = 0; i < panes->count; i++) {
        int32_t front = panes->inputs[i], back = scene_root_on(scene, front, false);
        struct rgb sum = {{0.0, 0.0, 0.0}};
        rgb_add(&sum, 0.5, seen_through(panes, octree, forest, front, 1.0));
        rgb_add(&sum, 0.5, seen_through(panes, octree, forest, front, -1.0));
        panes->sent[front] = sum;
        if (back >= 0)
            panes->sent[back] = sum;
    }
}
