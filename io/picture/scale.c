/* False colours.
 *
 * Colours are those of viridis (van der Walt and Smith, 2015), by a polynomial of degree
 * 6 in each band (within .02 of the table): they rise evenly in lightness, also for the
 * colour-blind and on paper. Numbers are drawn with a font of 5 x 7 dots, as large as the
 * picture lets them be. */
#include "io/picture/scale.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/alloc.h"
#include "io/picture/tone.h"

/* Luminous efficacy of white, lm/W (as Radiance has it), and of sRGB's bands. */
static const double EFFICACY = 179.0, LUMINANCE[BANDS] = {0.2126, 0.7152, 0.0722};

static const double SHOWN = 0.99; /* share of values within the scale */

enum { NUMBERS_MOST = 5, GLYPH_WIDTH = 5, GLYPH_HEIGHT = 7, ADVANCE = 6 };

double scale_value(const struct rgb *light, bool lux)
{
    double value = 0.0;
    for (int c = 0; c < BANDS; c++)
        value += light->band[c] * (lux ? EFFICACY * LUMINANCE[c] : 1.0 / BANDS);
    return value;
}

/* --- the scale --- */

static int compare_floats(const void *left, const void *right)
{
    const float *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static double value_at(const struct image *image, int64_t i, bool lux)
{
    const float *p = &image->rgb[3 * i];
    return scale_value(&(struct rgb){{(double)p[0], (double)p[1], (double)p[2]}}, lux);
}

/* Returns the least of 1, 2 and 5 times a power of ten not below a value. */
static double round_up(double value)
{
    double unit = 1.0;
    while (unit > value)
        unit /= 10.0;
    while (unit * 10.0 <= value)
        unit *= 10.0;
    return value <= unit ? unit : value <= 2 * unit ? 2 * unit
         : value <= 5 * unit ? 5 * unit : 10 * unit;
}

struct scale scale_choose(const struct image *image, double exposure, bool lux, int lines)
{
    int64_t pixels = (int64_t)image->width * image->height, count = 0;
    float *values = alloc_array((size_t)pixels, sizeof *values);
    struct scale scale = {.top = 1.0, .lux = lux, .lines = lines};
    for (int64_t i = 0; i < pixels; i++) {
        values[count] = (float)value_at(image, i, lux);
        count += values[count] > 0.0f;
    }
    qsort(values, (size_t)count, sizeof *values, compare_floats);
    if (count > 0)
        scale.top = (double)values[(int64_t)(SHOWN * (double)(count - 1))];
    alloc_free(values);
    scale.step = round_up(scale.top / NUMBERS_MOST);
    scale.top = scale.step * ceil(scale.top / scale.step - 1e-6);
    if (exposure > 0.0) {
        scale.top = (lux ? EFFICACY : 1.0) / exposure;
        scale.step = round_up(scale.top / NUMBERS_MOST);
    }
    return scale;
}

/* --- colours --- */

/* The linear light of a screen for a part of the scale. */
static void colour_of(const struct scale *scale, double t, float rgb[3])
{
    static const double POWERS[7][3] = {
        {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
        {0.1050930431085774, 1.404613529898575, 1.384590162594685},
        {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
        {-4.634230498983486, -5.799100973351585, -19.33244095627987},
        {6.228269936347081, 14.17993336680509, 56.69055260068105},
        {4.776384997670288, -13.74514537774601, -65.35303263337234},
        {-5.435455855934631, 4.645852612178535, 26.3124352495832}};
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    for (int c = 0; c < 3 && scale->signs; c++)
        rgb[c] = (float)fmin(1.0, c == 0 ? 2.0 * t : c == 2 ? 2.0 - 2.0 * t
                                                            : 1.0 - fabs(2.0 * t - 1.0));
    for (int c = 0; c < 3 && !scale->signs; c++) {
        double code = 0.0;
        for (int k = 6; k >= 0; k--)
            code = code * t + POWERS[k][c];
        code = code < 0.0 ? 0.0 : code > 1.0 ? 1.0 : code;
        rgb[c] = (float)tone_decode(code);
    }
}

static void fill(struct image *image, int x, int y, int width, int height, float grey)
{
    for (int j = y < 0 ? 0 : y; j < y + height && j < image->height; j++)
        for (int i = x < 0 ? 0 : x; i < x + width && i < image->width; i++)
            for (int c = 0; c < 3; c++)
                image->rgb[3 * ((size_t)j * (size_t)image->width + (size_t)i) +
                           (size_t)c] = grey;
}

/* Draws a text in black, its upper left corner at (x, y), with dots of a size. */
static void write_text(struct image *image, const char *text, int x, int y, int dot)
{
    /* A row of dots in each letter: its last five bits, the first dot highest. */
    static const char LETTERS[] = "0123456789.-+e^/Wmluxs";
    static const char *const ROWS[] = {
        "NQSUYQN", "DLDDDDN", "NQABDH_", "_BDBAQN", "BFJR_BB", "_P^AAQN", "FHP^QQN",
        "_ABDHHH", "NQQNQQN", "NQQOABL", "@@@@@LL", "@@@_@@@", "@DD_DD@", "@@NQ_PN",
        "DJQ@@@@", "AABDHPP", "QQQUUUJ", "@@ZUUQQ", "LDDDDDN", "@@QQQSM", "@@QJDJQ",
        "@@OPNA^"};
    for (; *text; text++, x += ADVANCE * dot) {
        const char *letter = strchr(LETTERS, *text);
        for (int k = 0; letter && k < GLYPH_WIDTH * GLYPH_HEIGHT; k++) {
            int column = k % GLYPH_WIDTH, row = k / GLYPH_WIDTH;
            if (ROWS[letter - LETTERS][row] >> (GLYPH_WIDTH - 1 - column) & 1)
                fill(image, x + column * dot, y + row * dot, dot, dot, 0.0f);
        }
    }
}

/* Draws the bar with its numbers and unit on a white strip at the lower edge. */
static void draw_bar(const struct scale *scale, struct image *image)
{
    enum { BAR = 6, STRIP = 18, LEAST = 120, DOT = 240 }; /* dots; pixels */
    const char *unit = scale->signs ? "s.e." : scale->lux ? "lux" : "W/m^2";
    double low = scale->signs ? -scale->top : 0.0, range = scale->top - low;
    int dot = image->height < 2 * DOT ? 1 : image->height / DOT;
    int left = 4 * dot, unit_width = ((int)strlen(unit) + 1) * ADVANCE * dot;
    int bar = image->width - unit_width - 8 * ADVANCE * dot, free = 0;
    int top = image->height - STRIP * dot;
    if (image->width < LEAST || top < 2 * STRIP * dot || bar < 1)
        return;
    fill(image, 0, top, image->width, STRIP * dot, 1.0f);
    for (int x = 0; x < bar; x++)
        for (int y = 0; y < BAR * dot; y++)
            colour_of(scale, (x + 0.5) / bar,
                      &image->rgb[3 * ((size_t)(top + dot + y) * (size_t)image->width +
                                       (size_t)(left + x))]);
    for (int k = 0; k * scale->step <= range * (1.0 + 1e-9); k++) {
        char number[32];
        int x = left + (int)(k * scale->step / range * bar);
        snprintf(number, sizeof number, "%.6g", low + k * scale->step);
        if (x < free)
            continue;
        fill(image, x, top + dot, dot, (BAR + 1) * dot, 0.0f);
        write_text(image, number, x, top + (BAR + 3) * dot, dot);
        free = x + ((int)strlen(number) + 1) * ADVANCE * dot;
    }
    write_text(image, unit, image->width - unit_width, top + (BAR + 3) * dot, dot);
}

/* The number of the band between lines of equal values. */
static int band_of(const struct scale *scale, float value)
{
    double band = (double)value / scale->top * (scale->lines + 1);
    return band < scale->lines ? (int)band : scale->lines;
}

void scale_paint(const struct scale *scale, struct image *image)
{
    int64_t pixels = (int64_t)image->width * image->height;
    float *values = alloc_array((size_t)pixels, sizeof *values);
    for (int64_t i = 0; i < pixels; i++)
        values[i] = (float)value_at(image, i, scale->lux);
    for (int64_t i = 0; i < pixels; i++) {
        bool last = i % image->width == image->width - 1;
        float right = values[last ? i : i + 1];
        float below = values[i + image->width < pixels ? i + image->width : i];
        double part = (double)values[i] / scale->top;
        if (scale->signs) {
            colour_of(scale, 0.5 + 0.5 * part, &image->rgb[3 * i]);
            continue;
        }
        int band = band_of(scale, values[i]);
        float *rgb = &image->rgb[3 * i];
        colour_of(scale, part, rgb);
        bool line = band != band_of(scale, right) || band != band_of(scale, below);
        for (int c = 0; c < 3 && (line || !(values[i] > 0.0f)); c++)
            rgb[c] = values[i] > 0.0f && part < 0.5 ? 1.0f : 0.0f;
    }
    alloc_free(values);
    draw_bar(scale, image);
}
