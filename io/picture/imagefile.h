/* Pictures in files of all formats. */
#ifndef IO_PICTURE_IMAGEFILE_H
#define IO_PICTURE_IMAGEFILE_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/picture/image.h"
#include "io/picture/tone.h"
#include "io/run/target.h"
#include "io/scene/binary.h"

/* Writes the format of the target: PFM (errors, too) and HDR, linear; or PPM and PNG, the
 * 8-bit codes of `tone`. Pre: the target is no mesh. Errors: as output_close(). */
bool image_write(const struct image *image, const struct tone *tone,
                 const struct target *target, struct error *error);

/* Reads PFM, PPM, HDR or PNG from an open file, as their readers do. `rgb` is to be
 * freed with alloc_free().
 * Errors: "PATH: REASON", EXIT_USAGE: not such a picture, bytes missing or left over, a
 * sample above the greatest value. */
bool image_read(struct image *image, enum image_kind *kind, struct source *source,
                struct error *error);

#endif
