/* A path tracer: the light that a surface reflects, without links, patches or form
 * factors.
 *
 * It shares the octree and the scene with the program and nothing of its method, so it is
 * what the program's answers are compared with. All seeds are hashed: the same seed gives
 * the same bits, and estimates with different seeds are independent. */
#ifndef TOOLS_PATHS_H
#define TOOLS_PATHS_H

#include <stdint.h>

#include "geom/scene.h"
#include "io/camera.h"
#include "octree/octree.h"

struct pathtracer {
    const struct scene *scene;    /* borrowed, prepared, something in it emits */
    const struct octree *octree;  /* borrowed, that of the scene */
    double *power;                /* [roots] of roots 0 .. r, W in square scene units */
    struct octree_counts *counts; /* rays so far; owned */
};

struct pathtracer pathtracer_make(const struct scene *scene, const struct octree *octree);
void pathtracer_free(struct pathtracer *pathtracer);

/* Point of a triangle with the given barycentric coordinates, which are x, y and z. */
struct vec3 triangle_point(const struct triangle *t, struct vec3 weight);

/* Estimate of the mean reflected radiosity rho H, W/m^2, over a part of a root: the
 * triangle whose corners have the given barycentric coordinates. Three equal corners ask
 * for a point. Its expectation is exact. Pre: samples > 0. */
struct rgb pathtracer_reflected(const struct pathtracer *pathtracer, int32_t root,
                                const struct triangle *part, int samples, uint64_t seed);

/* Estimate of the mean radiosity E + rho H, W/m^2, that is seen through pixel (x, y) of a
 * picture; black where nothing is met, or a back. Its expectation is exact.
 * Pre: samples > 0. */
struct rgb pathtracer_pixel(const struct pathtracer *pathtracer,
                            const struct camera *camera, int x, int y, int samples,
                            uint64_t seed);

#endif
