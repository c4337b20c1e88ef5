/* Radiosity at any point of the surfaces, interpolated smoothly from the leaves. */
#ifndef IO_SHADING_H
#define IO_SHADING_H

#include <stdbool.h>
#include <stdint.h>

#include "octree/octree.h"
#include "rad/patch.h"

struct shading {
    const struct forest *forest; /* borrowed */
    bool flat;                   /* each leaf shows its constant */
    int32_t *corners;            /* [3 * forest->count] vertex at corner k of leaf p: [3 p + k] */
    struct vec3 *positions;      /* [vertex_count] scene units */
    struct rgb *values;          /* [vertex_count] radiosity, W/m^2 */
    int64_t vertex_count;
};

/* Prepares the shading of a solution; `octree` is that of the scene, to see which leaves are
 * covered. Vertices are numbered as the leaves meet them, roots in
 * order, depth first: the same on every rank. `flat`: each leaf has three vertices of its own
 * with its constant. */
struct shading *shading_create(const struct forest *forest, const struct octree *octree, bool flat);
void shading_destroy(struct shading *shading);

/* Radiosity at the point of a root with the given barycentric coordinates, W/m^2. */
struct rgb shading_at(const struct shading *shading, int32_t root, const double weight[3]);

#endif
