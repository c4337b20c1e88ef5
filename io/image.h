/* Pictures: linear RGB in memory, PFM and PPM in files. */
#ifndef IO_IMAGE_H
#define IO_IMAGE_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/tone.h"

struct image {
    int width, height;
    float *rgb; /* [height][width][3], top row first, W/m^2; borrowed */
};

/* PFM: linear 32-bit floats, little endian, bottom row first, scale -1.
 * Errors: as output_close(). */
bool pfm_write(const struct image *image, const char *path, struct error *error);

/* PPM: 8-bit sRGB, top row first. */
bool ppm_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error);

#endif
