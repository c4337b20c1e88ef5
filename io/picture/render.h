/* Pictures of a solution: camera rays through the octree. */
#ifndef IO_PICTURE_RENDER_H
#define IO_PICTURE_RENDER_H

#include "geom/progress.h"
#include "io/scene/camera.h"
#include "io/picture/shading.h"
#include "rad/beyond/final_gather.h"

/* Where the light that is shown comes from. */
struct renderer {
    const struct octree *octree;
    const struct shading *shading; /* all light without `gather`; with it, what does not come
                                      straight from lamps; NULL where all is gathered */
    struct final_gather *gather;   /* finds light at the points that are shown, or NULL, */
    int rays;                      /* by so many rays or segments for a pixel */
};

struct renderer renderer_make(const struct octree *octree, const struct shading *shading,
                              struct final_gather *gather);

/* Radiosity at the point of a root with the given barycentric coordinates, W/m^2. */
struct rgb render_point(const struct renderer *renderer, int32_t root,
                        const double weight[3], uint64_t seed);

/* Renders the rows first, first + step, ... of the picture, top row first. Each pixel is the
 * mean of samples x samples rays; where nothing is met, or a back, it is black. Ticks
 * `progress`, which may be NULL, once a row.
 * Returns RGB floats, 3 * width for each row; to be freed with alloc_free(). */
float *render_rows(const struct renderer *renderer, const struct camera *camera, int samples,
                   int first, int step, struct progress *progress);

#endif
