/* Pictures: linear RGB in memory, PFM and PPM in files. */
#ifndef IO_PICTURE_IMAGE_H
#define IO_PICTURE_IMAGE_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/tone.h"
#include "io/scene/binary.h"

struct image {
    int width, height;
    float *rgb; /* [height][width][3], top scanline first, W/m^2 */
};

/* Writes PFM: linear 32-bit floats, little endian, bottom scanline first, scale -1.
 * Errors: as output_close(). */
bool pfm_write(const struct image *image, const char *path, struct error *error);

/* Writes PPM: 8-bit sRGB, top scanline first. Errors: as output_close(). */
bool ppm_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error);

enum image_kind { IMAGE_PFM, IMAGE_PPM };

/* Reads PFM, colour (PF) or grey (Pf, three equal bands), in either byte order, times the
 * magnitude of its scale; or PPM, plain (P3) or raw (P6) with one or two bytes a sample,
 * divided by its greatest value: 0..1, undecoded. Samples of a PFM may be NaN. `rgb` is
 * to be freed with alloc_free().
 * Errors: "PATH: REASON", EXIT_USAGE: not such a picture, bytes missing or left over, a
 * sample above the greatest value. */
bool image_read(struct image *image, enum image_kind *kind, const char *path,
                struct error *error);

/* Does the same with a file in memory, which it frees. */
bool image_of_binary(struct image *image, enum image_kind *kind, struct binary *binary,
                     struct error *error);

#endif
