/* PFM and PPM, the plain formats of Netpbm's family. */
#ifndef IO_PICTURE_PNM_H
#define IO_PICTURE_PNM_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/image.h"
#include "io/picture/tone.h"
#include "io/scene/binary.h"

/* Writes PFM: linear 32-bit floats, little endian, bottom scanline first, scale -1.
 * Errors: as output_close(). */
bool pfm_write(const struct image *image, const char *path, struct error *error);

/* Writes PPM: 8-bit sRGB, top scanline first. Errors: as output_close(). */
bool ppm_write(const struct image *image, const struct tone *tone, const char *path,
               struct error *error);

/* Reads PFM, colour (PF) or grey (Pf, three equal bands), in either byte order, times the
 * magnitude of its scale; or PPM, plain (P3) or raw (P6) with one or two bytes a sample,
 * divided by its greatest value: 0..1, undecoded. Samples of a PFM may be NaN. Errors: as
 * image_read(); `rgb` may then be allocated. */
bool pnm_read(struct image *image, enum image_kind *kind, struct binary *binary,
              struct error *error);

#endif
