/* Tests of geom/elementary.h against libm, which is right within a unit in the last
 * place, and against identities that hold in real numbers. */
#include "geom/elementary.h"

#include <float.h>
#include <math.h>

#include "tests/random.h"
#include "geom/vec.h"
#include "tests/tap.h"

enum { ARGUMENTS = 1000000 };

/* The bound of elementary.h, and a unit in the last place (2.2e-16 at most) for libm. */
static const double TOLERANCE = 4.5e-16 + 2.3e-16;

/* Relative; the least unit is the smallest normal number, below which digits are
 * lost. */
static double error_of(double value, double right)
{
    return fabs(value - right) / fmax(fabs(right), DBL_MIN);
}

/* Any sign, any exponent from -limit to limit. */
static double random_wide(struct random *random, int limit)
{
    int exponent = (int)(random_bits(random) % (uint64_t)(2 * limit)) - limit;
    double x = ldexp(0.5 + 0.5 * random_unit(random), exponent);
    return random_bits(random) & 1 ? x : -x;
}

static void test_arctangent(void)
{
    struct random random = random_seed(1);
    double even = 0.0, wide = 0.0, outside = 0.0;
    for (int i = 0; i < ARGUMENTS; i++) {
        double x = 2.0 * random_unit(&random) - 1.0, y = 2.0 * random_unit(&random) - 1.0;
        even = fmax(even, error_of(arctangent(y, x), atan2(y, x)));
        x = random_wide(&random, 1020);
        y = random_wide(&random, 1020);
        wide = fmax(wide, error_of(arctangent(y, x), atan2(y, x)));
        outside = fmax(outside, fabs(arctangent(y, x)));
    }
    tap_ok(even <= TOLERANCE, "arctangent in a square: off by %.1e at most", even);
    tap_ok(wide <= TOLERANCE, "arctangent of all magnitudes: off by %.1e at most", wide);
    tap_ok(outside <= PI, "never beyond pi");
}

static void test_arctangent_corners(void)
{
    static const double values[] = {0.0, DBL_MIN / 4, DBL_MIN, 1e-20, 0.0625, 0.1875,
                                    0.4375, 1.0, 1.0 + DBL_EPSILON, 3.0, 1e20,
                                    DBL_MAX / 2, DBL_MAX};
    enum { VALUES = sizeof values / sizeof values[0] };
    double worst = 0.0;
    for (int i = 0; i < 4 * VALUES * VALUES; i++) {
        double x = values[i / 4 % VALUES], y = values[i / 4 / VALUES];
        x = i & 1 ? -x : x;
        y = i & 2 ? -y : y;
        /* The sign of zero is not kept: both sides of the negative axis are pi. */
        double right = y == 0.0 ? (x < 0.0 ? PI : 0.0) : atan2(y, x);
        worst = fmax(worst, error_of(arctangent(y, x), right));
    }
    tap_ok(worst <= TOLERANCE, "arctangent at the corners of its range: off by %.1e",
           worst);
    tap_ok(arctangent(0.0, 0.0) == 0.0 && arctangent(0.0, -0.0) == 0.0,
           "0 for the origin");
    tap_ok(arctangent(0.0, -2.0) == PI && arctangent(3.0, 0.0) == PI / 2 &&
               arctangent(-3.0, 0.0) == -PI / 2 && arctangent(5.0, 5.0) == PI / 4,
           "the axes and the diagonal");
}

/* At the joints of the table the neighbours on both sides use different angles. */
static void test_arctangent_joints(void)
{
    int steps = 0, down = 0;
    for (int k = 0; k <= 8; k++) {
        double t = (2 * k + 1) / 16.0;
        for (int i = 0; i < 100; i++)
            t = nextafter(t, 0.0);
        for (int i = 0; i < 200; i++, t = nextafter(t, 2.0), steps++)
            down += arctangent(nextafter(t, 2.0), 1.0) < arctangent(t, 1.0) - 2.3e-16;
    }
    tap_ok(steps == 1800 && down == 0,
           "no step down, beyond a rounding, at the table's joints");
}

static void test_logarithm(void)
{
    struct random random = random_seed(2);
    double near = 0.0, wide = 0.0;
    for (int i = 0; i < ARGUMENTS; i++) {
        double x = 0.5 + 1.5 * random_unit(&random);
        near = fmax(near, error_of(logarithm(x), log(x)));
        x = fabs(random_wide(&random, 1020));
        wide = fmax(wide, error_of(logarithm(x), log(x)));
    }
    tap_ok(near <= TOLERANCE, "logarithm around 1: off by %.1e at most", near);
    tap_ok(wide <= TOLERANCE, "logarithm of all magnitudes: off by %.1e at most", wide);
    static const double corners[] = {DBL_MIN * DBL_EPSILON, DBL_MIN / 3, DBL_MIN, 0.5,
                                     1.0 - 0x1p-53, 1.0 + 0x1p-52, 2.0, DBL_MAX};
    double worst = 0.0;
    for (int i = 0; i < 8; i++)
        worst = fmax(worst, error_of(logarithm(corners[i]), log(corners[i])));
    tap_ok(worst <= TOLERANCE, "logarithm at the corners of its range: off by %.1e",
           worst);
    tap_ok(logarithm(1.0) == 0.0, "0 at 1");
}

static void test_exponential(void)
{
    struct random random = random_seed(3);
    double worst = 0.0;
    for (int i = 0; i < ARGUMENTS; i++) {
        double x = 1400.0 * random_unit(&random) - 700.0;
        x = i % 2 ? x : x / 1000.0;
        worst = fmax(worst, error_of(exponential(x), exp(x)));
    }
    tap_ok(worst <= TOLERANCE && exponential(0.0) == 1.0,
           "exponential: off by %.1e at most", worst);
}

int main(void)
{
    test_exponential();
    test_arctangent();
    test_arctangent_corners();
    test_arctangent_joints();
    test_logarithm();
    return tap_done();
}
