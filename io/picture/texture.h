/* Pictures on surfaces, of which one colour is taken. */
#ifndef IO_PICTURE_TEXTURE_H
#define IO_PICTURE_TEXTURE_H

#include <stdbool.h>

#include "geom/error.h"
#include "geom/vec.h"

/* Finds the mean of the linear light of a PNG or PPM, 1 for white, whose codes are those
 * of a screen (sRGB). The file has to be a regular one.
 * Errors: those of image_read(). */
bool texture_mean(const char *path, struct rgb *mean, struct error *error);

#endif
