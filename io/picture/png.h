/* PNG, written and read. */
#ifndef IO_PICTURE_PNG_H
#define IO_PICTURE_PNG_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/image.h"
#include "io/picture/tone.h"
#include "io/scene/binary.h"

/* Writes PNG: the codes of ppm_write(), marked as sRGB. Errors: as output_close(). */
bool png_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error);

/* Reads PNG of 8 bits a sample, not interlaced, divided by 255; alpha is skipped. Errors:
 * as image_read(); `rgb` may then be allocated. */
bool png_read(struct image *image, enum image_kind *kind, struct binary *binary,
              struct error *error);

#endif
