/* From linear light to the bytes of a screen. */
#ifndef IO_TONE_H
#define IO_TONE_H

#include <stdint.h>

struct tone {
    double exposure;     /* factor on linear values; 1 becomes full white */
    double threshold[255]; /* linear value from which code k + 1 is nearer than code k */
};

/* The sRGB curve with an exposure. */
struct tone tone_make(double exposure);

/* The 8-bit sRGB code of a linear value. */
uint8_t tone_encode(const struct tone *tone, double linear);

/* The exposure that brings the 95th percentile of the largest bands of `count` linear RGB pixels
 * to 0.9, so that hardly any colour is cut off; black pixels do not count. 1 if all are. */
double tone_automatic(const float *rgb, int64_t count);

#endif
