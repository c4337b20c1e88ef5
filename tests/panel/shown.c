/* Judges a picture of phr, a .pfm, for the panel (tests/panel/panel.sh).
 *
 *     shown PICTURE.pfm [TRUTH.pfm FIRST.pfm [ERROR.pfm]]
 *
 * TRUTH is traced by N paths a pixel, FIRST by a quarter of these, which are the first of
 * the others: so the two differ by sqrt(3) deviations of TRUTH. ERROR has the standard
 * errors of PICTURE. Printed are, a dash for what there is no truth of:
 *
 *     specks   pixels more than 5 codes off the median of their 3 x 3, where that is
 *              smooth: its middle five values lie within 4 codes
 *     grain    percent: RMS of pixels about the mean of their four neighbours, over the
 *              mean, in blocks of 8 x 8 whose quarters differ by less than a tenth; by
 *              chance alone it is the deviation of a pixel
 *     block    percent: RMS error of blocks of 8 x 8 over the light, less noise; lamps
 *              and skies, blocks with a pixel 16 times the median one, do not count
 *     most     percent: the largest error of a block of 16 x 16 over its own light
 *     peak     W/m^2: the brightest band of a pixel
 *     within   percent: blocks of 8 x 8 whose bands are within two standard errors
 *
 * Codes are those of a .png by the picture's own exposure. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/picture/imagefile.h"
#include "io/picture/tone.h"
#include "io/scene/source.h"
#include "tools/compare.h"

enum { FINE = 8, COARSE = 16 };

static bool read_image(struct image *image, const char *path, struct error *error)
{
    struct source source;
    enum image_kind kind;
    bool good = source_open(&source, path, error);
    good = good && image_read(image, &kind, &source, error);
    source_close(&source);
    return good;
}

static const float *pixel(const struct image *image, int x, int y)
{
    return &image->rgb[3 * ((size_t)y * (size_t)image->width + (size_t)x)];
}

static double light_of(const struct image *image, int x, int y)
{
    const float *rgb = pixel(image, x, y);
    return ((double)rgb[0] + (double)rgb[1] + (double)rgb[2]) / 3.0;
}

static int compare(const void *left, const void *right)
{
    const int *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static int compare_light(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Whether the pixel is a speck, by codes of its mean over bands. */
static bool is_speck(const int *codes, int width, int x, int y)
{
    int around[9], count = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            around[count++] = codes[(y + dy) * width + x + dx];
    qsort(around, 9, sizeof *around, compare);
    return around[6] - around[2] <= 4 && abs(codes[y * width + x] - around[4]) > 5;
}

static int64_t count_specks(const struct image *image, const struct tone *tone)
{
    int width = image->width, height = image->height;
    int *codes = alloc_array((size_t)width * (size_t)height, sizeof *codes);
    int64_t specks = 0;
    for (int i = 0; i < width * height; i++) {
        double sum = 0.0;
        for (int c = 0; c < 3; c++)
            sum += tone_encode(tone, (double)image->rgb[3 * i + c]);
        codes[i] = (int)(sum / 3.0 + 0.5);
    }
    for (int y = 1; y + 1 < height; y++)
        for (int x = 1; x + 1 < width; x++)
            specks += is_speck(codes, width, x, y);
    alloc_free(codes);
    return specks;
}

static double mean_of(const struct image *image, int x, int y, int side)
{
    double sum = 0.0;
    for (int i = 0; i < side * side; i++)
        sum += light_of(image, x + i % side, y + i / side);
    return sum / (side * side);
}

static bool is_smooth(const struct image *image, int x, int y, double mean)
{
    for (int q = 0; q < 4; q++) {
        int half = FINE / 2;
        double part = mean_of(image, x + q % 2 * half, y + q / 2 * half, half);
        if (!(fabs(part - mean) < 0.05 * mean))
            return false;
    }
    return true;
}

/* The light that lamps and skies exceed. */
static double least_of_lamps(const struct image *image)
{
    int count = image->width * image->height;
    double *light = alloc_array((size_t)count, sizeof *light);
    for (int i = 0; i < count; i++)
        light[i] = light_of(image, i % image->width, i / image->width);
    qsort(light, (size_t)count, sizeof *light, compare_light);
    double median = light[count / 2];
    alloc_free(light);
    return 16.0 * median;
}

static bool has_lamp(const struct image *image, double least, int x, int y, int side)
{
    for (int i = 0; i < side * side; i++)
        if (light_of(image, x + i % side, y + i / side) > least)
            return true;
    return false;
}

static double grain_of(const struct image *image)
{
    double least = least_of_lamps(image);
    double squares = 0.0;
    int64_t count = 0;
    for (int y = 0; y + FINE <= image->height; y += FINE)
        for (int x = 0; x + FINE <= image->width; x += FINE) {
            double mean = mean_of(image, x, y, FINE);
            if (!is_smooth(image, x, y, mean) || has_lamp(image, least, x, y, FINE))
                continue;
            for (int i = 0; i < FINE * FINE; i++) {
                int px = x + i % FINE, py = y + i / FINE;
                if (i % FINE % (FINE - 1) == 0 || i / FINE % (FINE - 1) == 0)
                    continue;
                double around =
                    light_of(image, px - 1, py) + light_of(image, px + 1, py) +
                    light_of(image, px, py - 1) + light_of(image, px, py + 1);
                double off = (light_of(image, px, py) - 0.25 * around) / mean;
                squares += off * off / 1.25;
                count++;
            }
        }
    return count > 0 ? sqrt(squares / (double)count) : 0.0;
}

/* The RMS of the differences of blocks over the RMS of b, and the largest over a block's
 * own light. */
struct off {
    double rms, most;
};

static struct off differ(const struct image *a, const struct image *b, int side)
{
    double least = least_of_lamps(b);
    double squares = 0.0, light = 0.0, most = 0.0;
    for (int y = 0; y + side <= b->height; y += side)
        for (int x = 0; x + side <= b->width; x += side) {
            double truth = mean_of(b, x, y, side), off = mean_of(a, x, y, side) - truth;
            if (has_lamp(b, least, x, y, side))
                continue;
            squares += off * off;
            light += truth * truth;
            if (truth > 0.0)
                most = fmax(most, fabs(off) / truth);
        }
    return (struct off){light > 0.0 ? sqrt(squares / light) : 0.0, most};
}

int main(int argc, char **argv)
{
    struct image image[4] = {{0}};
    struct error error = {0};
    bool good = argc == 2 || argc == 4 || argc == 5 ||
                error_set(&error, EXIT_USAGE,
                          "usage: shown PICTURE [TRUTH FIRST [ERROR]]");
    for (int i = 1; good && i < argc; i++)
        good = read_image(&image[i - 1], argv[i], &error);
    if (good) {
        int64_t pixels = (int64_t)image[0].width * image[0].height;
        struct tone tone = tone_make(tone_automatic(image[0].rgb, pixels));
        printf("%lld %.3g", (long long)count_specks(&image[0], &tone),
               100.0 * grain_of(&image[0]));
        if (argc >= 4) {
            double noise = differ(&image[2], &image[1], FINE).rms;
            double block = differ(&image[0], &image[1], FINE).rms;
            printf(" %.3g %.3g",
                   100.0 * sqrt(fmax(0.0, block * block - noise * noise / 3.0)),
                   100.0 * differ(&image[0], &image[1], COARSE).most);
        } else {
            printf(" - -");
        }
        double peak = 0.0;
        for (int64_t i = 0; i < 3 * pixels; i++)
            peak = fmax(peak, (double)image[0].rgb[i]);
        printf(" %.3g", peak);
        if (argc == 5) {
            struct deviations off = compare_errors(&image[1], &image[0], &image[3], FINE,
                                                   HUGE_VAL, 2.0, NULL);
            printf(" %.3g\n", 100.0 - 100.0 * (double)off.unlike / (double)off.blocks);
        } else {
            printf(" -\n");
        }
    } else {
        fprintf(stderr, "shown: %s\n", error.text);
    }
    for (int i = 0; i < 4; i++)
        alloc_free(image[i].rgb);
    return error.code;
}
