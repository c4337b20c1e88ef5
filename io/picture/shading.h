/* Radiosity at any point of the surfaces, interpolated smoothly from the leaves. */
#ifndef IO_PICTURE_SHADING_H
#define IO_PICTURE_SHADING_H

#include <stdbool.h>
#include <stdint.h>

#include "octree/octree.h"
#include "rad/patch.h"

/* Where interpolation over a leaf holds. */
enum shade {
    SHADE_SMOOTH,  /* at all points seen by a camera */
    SHADE_COVERED, /* nowhere: only less than a quarter is open */
    SHADE_STEEP    /* nowhere: light varies by more than its mean over all surfaces */
};

/* The standard deviation of a leaf's radiosity, in parts of its error, 1. */
extern const double DEVIATION;

struct shading {
    const struct forest *forest; /* borrowed */
    bool flat;                   /* each leaf has its constant radiosity */
    int32_t *corners;            /* [3 * forest->count] vertex of p, k: [3 p + k] */
    struct vec3 *positions;      /* [vertex_count] scene units */
    struct rgb *values;          /* [vertex_count] radiosity, W/m^2 */
    struct rgb *lamps;           /* [vertex_count] by lamps, if not in `values`, W/m^2 */
    int64_t vertex_count;
    int64_t own_count;           /* vertices before those of a sky */
    bool *divided;               /* [forest->count] leaf with T-vertices */
    uint8_t *shades;             /* [forest->count] enum shade of a leaf */
    struct vertices *vertices;   /* finds vertices; owns positions */
};

/* Prepares the smooth shading of a solution. `octree`: over the scene's triangles: leaves
 * with one of these between them share no vertex. `less`: [patches] radiosity to
 * subtract, W/m^2: by the light of lamps, with its shadows; or NULL. `error`: [patches]
 * of the radiosity of leaves, as in the mesh, W/m^2, or NULL; heeded only with `less`.
 * `outside`: [patches] share of a leaf outside of things on it and of narrow gaps, 1;
 * NULL: all leaves are open. Vertices are numbered in the canonical order of leaves: the
 * same on every rank. */
struct shading *shading_create(const struct forest *forest, const struct octree *octree,
                               const struct rgb *less, const float *error,
                               const float *outside);

/* Prepares flat shading: each leaf has three vertices of its own with its constant. */
struct shading *shading_create_flat(const struct forest *forest);
void shading_destroy(struct shading *shading);

/* Interpolates these values at vertices there: shading->values, or shading->lamps. */
struct rgb shading_at(const struct shading *shading, const struct rgb *values,
                      int32_t root, const double weight[3]);

#endif
