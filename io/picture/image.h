/* Pictures: linear RGB in memory, PFM and PPM in files. */
#ifndef IO_PICTURE_IMAGE_H
#define IO_PICTURE_IMAGE_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/tone.h"
#include "io/scene/binary.h"

struct image {
    int width, height;
    float *rgb; /* [height][width][3], top row first, W/m^2; borrowed by the writers */
};

/* PFM: linear 32-bit floats, little endian, bottom row first, scale -1.
 * Errors: as output_close(). */
bool pfm_write(const struct image *image, const char *path, struct error *error);

/* PPM: 8-bit sRGB, top row first. */
bool ppm_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error);

enum image_kind { IMAGE_PFM, IMAGE_PPM };

/* Reads PFM, colour (PF) or grey (Pf, three equal bands), in either byte order, times the
 * magnitude of its scale; or PPM, plain (P3) or raw (P6) with one or two bytes a sample, as
 * shares of its greatest value, 0..1, undecoded. `rgb` is to be freed with alloc_free(). What
 * a PFM holds is not judged: samples may be NaN.
 * Errors: "PATH: what is wrong", EXIT_USAGE: not such a picture, cut off, longer than it says,
 * a sample above the greatest value. */
bool image_read(struct image *image, enum image_kind *kind, const char *path,
                struct error *error);

/* The same for a file in memory, which it takes over. */
bool image_of_binary(struct image *image, enum image_kind *kind, struct binary *binary,
                     struct error *error);

/* The file that image_of_binary() reads. Errors: those of binary_read(). */
bool image_load(struct binary *binary, const char *path, struct error *error);

#endif
