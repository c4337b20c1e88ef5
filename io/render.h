/* Pictures of a solution: camera rays through the octree. */
#ifndef IO_RENDER_H
#define IO_RENDER_H

#include "geom/progress.h"
#include "io/camera.h"
#include "io/shading.h"
#include "octree/octree.h"

/* Renders the rows first, first + step, ... of the picture, top row first. Each pixel is the
 * mean of samples x samples rays; where nothing is met, or a back, it is black. Ticks
 * `progress`, which may be NULL, once a row.
 * Returns RGB floats, 3 * width for each row; to be freed with alloc_free(). */
float *render_rows(const struct shading *shading, const struct octree *octree,
                   const struct camera *camera, int samples, int first, int step,
                   struct progress *progress);

#endif
