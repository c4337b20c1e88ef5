/* Tests of io/picture/tone.h. Proved are: the codes are those of the sRGB formula,
 * computed here with pow() in the forward direction, while io/picture/tone.c inverts it
 * without pow(); they stay in range; the automatic exposure is the
 * percentile that its contract names. */
#include "io/picture/tone.h"

#include <math.h>

#include "tests/random.h"
#include "tests/tap.h"

/* 255 s of the sRGB curve (IEC 61966-2-1), not rounded. */
static double srgb_scaled(double linear)
{
    double x = linear < 0.0 ? 0.0 : linear > 1.0 ? 1.0 : linear;
    return 255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055);
}

/* Whether `code` is the nearest to the formula. At a threshold, where 255 s + 1/2 is a
 * whole number, both neighbours are: 1e-12 relative is 50 times the error of pow() and of
 * this line. */
static bool code_is_right(int code, double linear)
{
    double scaled = srgb_scaled(linear) + 0.5;
    int nearest = (int)scaled;
    double whole = floor(scaled + 0.5);
    bool doubtful = fabs(scaled - whole) <= 1e-12 * scaled;
    return code == nearest ||
           (doubtful && (code == (int)whole || code == (int)whole - 1));
}

static void test_formula(void)
{
    struct tone tone = tone_make(1.0);
    struct random random = random_seed(1);
    int wrong = 0;
    for (int i = 0; i < 100000; i++) {
        double linear = random_unit(&random);
        linear = i % 2 ? 1.2 * linear
                       : exp(-14.0 * linear); /* evenly, or evenly in logarithm */
        wrong += !code_is_right(tone_encode(&tone, linear), linear);
    }
    tap_ok(wrong == 0, "100,000 codes follow the formula (%d do not)", wrong);
}

/* Steps from below to above each threshold, found by the formula alone. */
static void test_thresholds(void)
{
    struct tone tone = tone_make(1.0);
    int right = 0;
    for (int k = 0; k < 255; k++) {
        double s = (k + 0.5) / 255.0;
        double x = s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
        right += tone_encode(&tone, x * (1.0 - 1e-12)) == k &&
                 tone_encode(&tone, x * (1.0 + 1e-12)) == k + 1;
    }
    tap_ok(right == 255,
           "the code changes within 1e-12 of each of 255 thresholds (of %d)", right);
}

/* Numbers outside 0..1. */
static void test_range(void)
{
    struct tone tone = tone_make(1.0);
    tap_ok(tone_encode(&tone, -0.0) == 0 && tone_encode(&tone, -1e300) == 0 &&
               tone_encode(&tone, -HUGE_VAL) == 0,
           "less than 0 has the code 0");
    tap_ok(tone_encode(&tone, 1.0) == 255 && tone_encode(&tone, 1e300) == 255 &&
               tone_encode(&tone, HUGE_VAL) == 255,
           "1 and more has the code 255");
}

static void test_exposure(void)
{
    struct tone plain = tone_make(1.0), quarter = tone_make(0.25),
                strong = tone_make(1e6);
    int wrong = 0;
    for (int i = 0; i < 1000; i++) {
        double linear = i / 700.0;
        wrong += tone_encode(&quarter, 4.0 * linear) != tone_encode(&plain, linear);
    }
    tap_ok(wrong == 0, "an exposure of 1/4 shows 4 x as 1 shows x");
    tap_ok(tone_encode(&strong, 1e-6) == 255 && tone_encode(&strong, 0.5e-6) == 188,
           "an exposure of 1,000,000");
}

enum { PIXELS = 1000 };

/* `bright` of the lit pixels have 50 in band `band`, the others 2; `black` are black. */
static double exposure_of(int bright, int black, int band)
{
    float rgb[3 * PIXELS] = {0.0f};
    for (int i = 0; i < PIXELS - black; i++) {
        int at = i * 7 % PIXELS; /* in no order */
        rgb[3 * at + band] = i < bright ? 50.0f : 2.0f;
        rgb[3 * at + (band + 1) % 3] = 1.0f;
    }
    return tone_automatic(rgb, PIXELS);
}

/* 0.9 / x is one division: 1e-15 is four roundings. */
static void check_exposure(const char *name, double exposure, double expected)
{
    tap_ok(fabs(exposure - expected) <= 1e-15 * expected, "%s: %g", name, exposure);
}

static void test_automatic(void)
{
    float few[3 * 21], black[3 * 4] = {0.0f}, one[3] = {0.0f, 0.0f, 3.0f};
    for (int i = 0; i < 21; i++)
        few[3 * i] = few[3 * i + 1] = few[3 * i + 2] = (float)(21 - i);
    check_exposure("the 95th percentile of 1..21 is 20", tone_automatic(few, 21),
                   0.9 / 20.0);
    check_exposure("one pixel", tone_automatic(one, 1), 0.9 / 3.0);
    for (int band = 0; band < 3; band++) {
        check_exposure("48 in 1000 are bright", exposure_of(48, 0, band), 0.9 / 2.0);
        check_exposure("52 in 1000 are bright", exposure_of(52, 0, band), 0.9 / 8.0);
    }
    check_exposure("40 of 500 that are not black", exposure_of(40, 500, 0), 0.9 / 8.0);
    check_exposure("20 of 500 that are not black", exposure_of(20, 500, 0), 0.9 / 2.0);
    float spot[3 * 10] = {0.0f}, slope[3 * 5] = {0.0f};
    for (int i = 0; i < 10; i++)
        spot[3 * i] = i == 9 || i == 2 ? 80.0f : 1e-9f;
    check_exposure("a spot in the dark", tone_automatic(spot, 10), 16.0 * 0.9 / 80.0);
    for (int i = 0; i < 5; i++)
        slope[3 * i + 1] = (float)(i + 1);
    check_exposure("within four medians the percentile counts", tone_automatic(slope, 5),
                   0.9 / 4.0);
    tap_ok(tone_automatic(black, 4) == 1.0, "all black: 1");
    tap_ok(tone_automatic(NULL, 0) == 1.0, "no pixels: 1");
}

int main(void)
{
    test_formula();
    test_thresholds();
    test_range();
    test_exposure();
    test_automatic();
    return tap_done();
}
