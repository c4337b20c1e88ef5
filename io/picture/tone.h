/* From linear light to the bytes of a screen. */
#ifndef IO_PICTURE_TONE_H
#define IO_PICTURE_TONE_H

#include <stdint.h>

struct tone {
    double exposure;       /* factor on linear values: their product 1 is full white */
    double threshold[255]; /* least product with code k + 1 and not k */
};

/* Returns the sRGB curve with an exposure. */
struct tone tone_make(double exposure);

/* Returns the 8-bit sRGB code of a linear value. */
uint8_t tone_encode(const struct tone *tone, double linear);

/* Returns the linear value of an sRGB code, both as shares of white. */
double tone_decode(double code);

/* Returns the exposure for `count` linear RGB pixels, from the largest band of each pixel
 * not black. The exposure maps to 0.9 the 95th percentile of these values, so hardly any
 * colour is cut off, or four times their median if lower, but at least a 16th of the
 * percentile. 1 if all pixels are black. */
double tone_automatic(const float *rgb, int64_t count);

/* Returns the curve with an exposure, or, if that is 0, with the one for these pixels. */
struct tone tone_choose(double exposure, const float *rgb, int64_t count);

#endif
