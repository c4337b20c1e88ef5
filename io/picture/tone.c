/* Tone.
 *
 * The sRGB curve has a power, and pow() differs from library to library in the last bit,
 * enough to change a byte of a golden image. So codes are found by comparing with 255
 * thresholds, and these come from the inverse curve, ((s + 0.055) / 1.055)^2.4 = u^2
 * (u^2)^(1/5), whose fifth root takes only + * / with Newton's method.
 *
 * The automatic exposure goes by percentiles of the lit pixels: an average would follow a
 * tiny lamp a thousand times brighter than its room, and fall with every black pixel
 * around an object. The 95th percentile shows such a room well, but not a room whose
 * windows are a tenth of the picture; so light above four times the median may be cut off
 * (a grey card is then in the middle of the range). A picture nearly dark but for one lit
 * spot shows the spot. */
#include "io/picture/tone.h"

#include <stddef.h>
#include <stdlib.h>

#include "geom/alloc.h"

static const double PERCENTILE = 0.95, SHOWN = 0.9;
static const double HIGHLIGHT = 4.0; /* values up to this many medians are not cut off */
static const double SPOT = 16.0;     /* the percentile becomes at most SPOT * SHOWN */

static double fifth_root(double x)
{
    double y = 1.0; /* above the root of x < 1: the iteration falls steadily */
    for (int step = 0; step < 40; step++)
        y = (4.0 * y + x / (y * y * y * y)) / 5.0;
    return y;
}

double tone_decode(double s)
{
    if (s <= 0.04045)
        return s / 12.92;
    double u = (s + 0.055) / 1.055;
    return u * u * fifth_root(u * u);
}

struct tone tone_make(double exposure)
{
    struct tone tone = {.exposure = exposure};
    for (int k = 0; k < 255; k++)
        tone.threshold[k] = tone_decode((k + 0.5) / 255.0);
    return tone;
}

uint8_t tone_encode(const struct tone *tone, double linear)
{
    double value = tone->exposure * linear;
    int low = 0, high = 255; /* the code is in low..high */
    while (low < high) {
        int middle = (low + high) / 2;
        if (value >= tone->threshold[middle])
            low = middle + 1;
        else
            high = middle;
    }
    return (uint8_t)low;
}

static int compare_floats(const void *left, const void *right)
{
    const float *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

double tone_automatic(const float *rgb, int64_t count)
{
    float *brightest = alloc_array((size_t)count, sizeof *brightest);
    int64_t lit = 0;
    for (int64_t i = 0; i < count; i++) {
        const float *p = &rgb[3 * i];
        float largest = p[0] > p[1] ? p[0] : p[1];
        largest = p[2] > largest ? p[2] : largest;
        if (largest > 0.0f)
            brightest[lit++] = largest;
    }
    double exposure = 1.0;
    if (lit > 0) {
        qsort(brightest, (size_t)lit, sizeof *brightest, compare_floats);
        double high = (double)brightest[(int64_t)(PERCENTILE * (double)(lit - 1))];
        double middle = HIGHLIGHT * (double)brightest[(lit - 1) / 2];
        double white = middle < high ? middle : high;
        exposure = SHOWN / (white > high / SPOT ? white : high / SPOT);
    }
    alloc_free(brightest);
    return exposure;
}

struct tone tone_choose(double exposure, const float *rgb, int64_t count)
{
    return tone_make(exposure > 0.0 ? exposure : tone_automatic(rgb, count));
}
