/* A pixel of a camera's picture, by the path tracer of rad/beyond/paths.h. */
#ifndef TOOLS_PIXEL_H
#define TOOLS_PIXEL_H

#include "io/scene/camera.h"
#include "rad/beyond/paths.h"

/* Returns an estimate of the mean radiosity E + rho H, W/m^2, seen through pixel (x, y)
 * of a picture; a path meeting nothing, or a back, is black. Its expectation is exact.
 * Pre: samples > 0. */
struct rgb pathtracer_pixel(const struct pathtracer *pathtracer,
                            const struct camera *camera, int x, int y, int samples,
                            uint64_t seed);

#endif
