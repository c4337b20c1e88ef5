/* Light as one number, and as a false colour with a scale. */
#ifndef IO_PICTURE_SCALE_H
#define IO_PICTURE_SCALE_H

#include <stdbool.h>

#include "geom/vec.h"
#include "io/picture/image.h"

/* Returns the mean over the bands, W/m^2; or, for lux, the illuminance of light of sRGB's
 * bands with 179 lm in a W of white. */
double scale_value(const struct rgb *light, bool lux);

struct scale {
    double top;  /* value of the last colour and more */
    double step; /* between numbers of the scale */
    bool signs;  /* the scale begins at -top: red above 0, blue below, standard errors */
    bool lux;    /* else W/m^2 */
    int lines;   /* lines of equal values, this many below the top; 0: none */
};

/* Returns the scale of a picture: a round number not below 99 % of the values but
 * zeros. `exposure`: 1 / top of it, in W/m^2; 0: chosen. */
struct scale scale_choose(const struct image *image, double exposure, bool lux,
                          int lines);

/* Puts false colours in the place of light, in linear light of a screen, and draws the
 * scale at the lower edge, with its unit, where the picture has room for it. */
void scale_paint(const struct scale *scale, struct image *image);

#endif
