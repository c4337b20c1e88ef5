/* Tests of rad/compact.h: round trips, the direction of rounding, order, and the ends. */
#include "rad/compact.h"

#include <float.h>

#include "tests/scenes.h"
#include "tests/tap.h"

enum { TRIES = 100000 };

static void test_float_below(void)
{
    struct random random = random_seed(1);
    bool below = true, largest = true;
    for (int i = 0; i < TRIES; i++) {
        double x = ldexp(1.0 + random_unit(&random), random_below(&random, 140) - 130);
        float f = float_below(x);
        below = below && (double)f <= x;
        largest = largest && (double)nextafterf(f, HUGE_VALF) > x;
        largest = largest && float_below((double)f) == f;
    }
    tap_ok(below, "a float below is never above");
    tap_ok(largest, "and the next one is; floats stay as they are");
    tap_ok(float_below(0.0) == 0.0f && float_below(1e-60) == 0.0f &&
               float_below(1.0 - DBL_EPSILON) < 1.0f && float_below(1e38) <= 1e38f &&
               float_below(nextafter(1.0, 0.0)) == 1.0f - 0.5f * FLT_EPSILON,
           "zero, numbers too small for a float, and just below 1");
}

static void test_codes(void)
{
    bool kept = true, powers = true;
    for (int code = 0; code < 256; code++) {
        double value = expand8((uint8_t)code);
        kept = kept && compact8(value) == code;
        powers = powers && value == ldexp(1.0 + (code % 8) / 8.0, code / 8);
    }
    tap_ok(kept, "all 256 costs come back");
    tap_ok(powers, "five bits of exponent, three of mantissa");
    tap_ok(expand8(0) == 1.0 && expand8(255) == 1.875 * 2147483648.0,
           "from 1 to 1.875 x 2^31");
}

static void test_rounding(void)
{
    struct random random = random_seed(2);
    bool up = true, near = true;
    for (int i = 0; i < TRIES; i++) {
        double x = ldexp(1.0 + random_unit(&random), random_below(&random, 31));
        double found = expand8(compact8(x));
        /* On the way x becomes a float: off by 2^-24 of itself at most. */
        up = up && found >= x * (1.0 - 0x1p-24);
        near = near && found < 1.125 * x * (1.0 + 0x1p-24);
    }
    tap_ok(up, "costs are rounded up");
    tap_ok(near, "by less than an eighth");
    tap_ok(compact8(1.0) == 0 && compact8(1.0001) == 1 && compact8(1.125) == 1 &&
               compact8(1.1251) == 2 && compact8(1.875) == 7 && compact8(1.876) == 8,
           "near 1");
    tap_ok(compact8(1.875 * 2147483648.0) == 255 && compact8(1e10) == 255 &&
               compact8(1e300) == 255 && compact8(HUGE_VAL) == 255 &&
               compact8(1.75 * 2147483648.0) == 254,
           "numbers above the largest become the largest");
}

int main(void)
{
    test_float_below();
    test_codes();
    test_rounding();
    return tap_done();
}
