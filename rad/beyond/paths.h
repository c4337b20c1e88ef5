/* A path tracer: the light reflected by a surface, without links, patches or form
 * factors; and light paths, which go the other way.
 *
 * The tracer shares the octree and the scene with the program and nothing of its method:
 * tests and --accuracy compare the program's answers with its estimates. All seeds are
 * hashed: the same seed gives the same bits, on every machine, and estimates with
 * different seeds are independent. */
#ifndef RAD_BEYOND_PATHS_H
#define RAD_BEYOND_PATHS_H

#include <stdint.h>

#include "geom/scene.h"
#include "octree/octree.h"
#include "rad/patch.h"
#include "rad/beyond/panes.h"
#include "rad/beyond/sample.h"

struct pathtracer {
    const struct scene *scene;    /* borrowed, prepared, with some emission */
    const struct octree *octree;  /* borrowed, the scene's */
    struct panes *panes;          /* NULL: none */
    double *power;                /* [roots] of roots 0 .. r, W in square scene units,
                                     each times its favour */
    const double *favour;         /* [roots] borrowed; NULL: 1 */
    bool *hidden;                 /* [roots] lamps that no ray meets: below another
                                     face */
    const struct forest *guess;   /* reflected radiosity, to take noise from paths, or
                                     NULL; expectations are the same, right or wrong */
    struct octree_counts *counts; /* rays so far; owned */
};

struct pathtracer pathtracer_make(const struct scene *scene, const struct octree *octree);
void pathtracer_free(struct pathtracer *pathtracer);

/* Has paths choose lights by power times `favour`, [roots], above 0: expectations are the
 * same. Light paths are not to be followed then. */
void pathtracer_favour(struct pathtracer *pathtracer, const double *favour);

/* Estimate of the mean reflected radiosity rho H, W/m^2, over a part of a root: the
 * triangle whose corners have the given barycentric coordinates. Three equal corners ask
 * for a point. Its expectation is exact. Pre: samples > 0. */
struct rgb pathtracer_reflected(const struct pathtracer *pathtracer, int32_t root,
                                const struct triangle *part, int samples, uint64_t seed);

/* Where a light path arrives. */
struct landing {
    int32_t root;
    double weight[3]; /* barycentric coordinates in the root */
    struct rgb light; /* arriving, as a share of the power of all lights and bands */
};

/* Follows one light path from a light on, and tells of each place of arrival. The sum of
 * `light` over the landings in an area, times all power, over the number of paths and the
 * area, has the mean irradiance as its expectation; each is at most 1. */
void pathtracer_shine(const struct pathtracer *pathtracer, uint64_t seed,
                      void (*land)(void *listener, const struct landing *landing),
                      void *listener);

/* Power emitted by all lights, in all bands, W in square scene units. */
double pathtracer_power(const struct pathtracer *pathtracer);

/* Barycentric coordinates of the corners of a patch in its root: a part, as above. */
struct triangle pathtracer_part(struct patch_id id);

/* A ray of a picture, for a place u, v in [0, 1) within a pixel. */
typedef struct half_line pixel_ray(const void *pixel, double u, double v);

/* Estimate of the mean radiosity E + rho H, W/m^2, met by the rays of a pixel; black
 * where rays meet nothing, or a back. Its expectation is exact. `fronts_only`: rays look
 * through backs. Pre: samples > 0. */
struct rgb pathtracer_seen(const struct pathtracer *pathtracer, pixel_ray *ray,
                           const void *pixel, bool fronts_only, int samples,
                           uint64_t seed);

#endif
