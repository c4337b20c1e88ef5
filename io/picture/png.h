/* PNG, written. */
#ifndef IO_PICTURE_PNG_H
#define IO_PICTURE_PNG_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/image.h"
#include "io/picture/tone.h"

/* Writes PNG: the codes of ppm_write(), marked as sRGB. Errors: as output_close(). */
bool png_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error);

#endif
