/* Radiance's pictures (.hdr, .pic): linear light, a common exponent for each pixel. */
#ifndef IO_PICTURE_HDR_H
#define IO_PICTURE_HDR_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/image.h"
#include "io/scene/binary.h"

/* Writes bytes R, G, B and E of a pixel for R/256 2^(E-128) and so on, R, G, B rounded
 * to nearest, top scanline first, without run lengths. The error of a band is at most
 * 1/256 of the largest band of its pixel. Below 2^-128, negative and NaN become 0; the
 * largest value is 255/256 2^127. Errors: as output_close(). */
bool hdr_write(const struct image *image, const char *path, struct error *error);

/* Reads such a picture, with run lengths by band or without, divided by the product of
 * its EXPOSURE lines. Scanlines go from left to right, from the top down (-Y +X). Errors:
 * as image_read(); `rgb` may then be allocated. */
bool hdr_read(struct image *image, enum image_kind *kind, struct binary *binary,
              struct error *error);

#endif
