/* Pictures on surfaces, of which mean colours are taken. */
#ifndef IO_PICTURE_TEXTURE_H
#define IO_PICTURE_TEXTURE_H

#include "io/scene/maps.h"

/* Finds the means of the linear light of a PNG or PPM over parts, and over the whole: see
 * map_mean. Its codes are those of a screen (sRGB). The file has to be a regular one.
 * Errors: those of image_read(). */
bool texture_mean(const char *path, const struct map_part *parts, int64_t count,
                  struct rgb *means, struct error *error);

#endif
