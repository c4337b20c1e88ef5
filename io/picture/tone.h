/* From linear light to the bytes of a screen. */
#ifndef IO_PICTURE_TONE_H
#define IO_PICTURE_TONE_H

#include <stdint.h>

struct tone {
    double exposure;     /* factor on linear values; 1 becomes full white */
    double threshold[255]; /* linear value from which code k + 1 is nearer than code k */
};

/* The sRGB curve with an exposure. */
struct tone tone_make(double exposure);

/* The 8-bit sRGB code of a linear value. */
uint8_t tone_encode(const struct tone *tone, double linear);

/* The exposure for `count` linear RGB pixels, by the largest band of each that is not black: it brings to
 * 0.9 their 95th percentile, so that hardly any colour is cut off, or four times their median if that is
 * less, but at least a 16th of the percentile. 1 if all are black. */
double tone_automatic(const float *rgb, int64_t count);

#endif
