/* Pictures of a solution: camera rays through the octree. */
#ifndef IO_PICTURE_RENDER_H
#define IO_PICTURE_RENDER_H

#include "geom/progress.h"
#include "io/scene/camera.h"
#include "io/picture/shading.h"
#include "rad/beyond/gather/row.h"

/* The sources of the light in a picture: the mesh, a final gather, or both. */
struct renderer {
    const struct octree *octree;
    const struct shading *shading; /* all light; with `gather`, not the direct; or NULL */
    struct final_gather *gather;   /* direct light, and all where `shading` does not
                                      hold; without `shading`, all; or NULL */
    const float *error;            /* [patches] bound on the error of a leaf's light, for
                                      95 % of leaves, W/m^2; NULL: no errors are wanted */
    int rays;                      /* from a leaf; without `shading` for a pixel */
    bool irradiance;               /* H in place of B: as if all were white */
    double brighter;               /* mean of H, if that is shown, over that of B; or 1 */
};

struct renderer renderer_make(const struct octree *octree, const struct shading *shading,
                              struct final_gather *gather);

/* Returns the radiosity at the point of a root with these barycentric coordinates,
 * W/m^2. */
struct rgb render_point(const struct renderer *renderer, int32_t root,
                        const double weight[3], uint64_t seed);

/* Renders the scanlines first, first + step, ... of the picture, counted from the top. A
 * pixel is the mean of samples x samples rays; a ray meeting nothing, or a back, is
 * black. Ticks `progress`, which may be NULL, once a scanline. After a signal pixels not
 * done are -1.
 * Returns RGB floats, 3 * width for each scanline, with `error` as many more behind them:
 * the standard errors of the pixels, W/m^2. To be freed with alloc_free(). */
float *render_scanlines(const struct renderer *renderer, const struct camera *camera,
                        int samples, int first, int step, struct progress *progress);

#endif
