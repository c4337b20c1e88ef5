/* Arctangent by a table of nine angles, logarithm by the area tangent, exponential by its
 * series.
 *
 * Arctangent. The point is turned into the first octant, where t = min / max is in [0,
 * 1]. With c = k / 8 the number nearest to t,
 *
 *     atan t = atan c + atan z,    z = (t - c) / (1 + c t),    |z| <= 1/16,
 *
 * t - c is exact, and the odd Taylor series to z^13 leaves out less than 2e-19. The last
 * term added is the angle of the table, so the error comes from one rounding and from the
 * table: one unit or two in the last place, and none for c = 0, where the result may be
 * small.
 *
 * Logarithm. With x = 2^e m, m in [sqrt(1/2), sqrt(2)), and f = m - 1, which is exact,
 *
 *     ln m = 2 artanh s = 2 s + 2 s^3/3 + 2 s^5/5 + ...,   s = f / (2 + f),  |s| < 0.172;
 *
 * s^23 is the first power left out, 1e-18 of s. So that the rounding of s does not count,
 * 2 s is written as f - (f^2/2 - s f^2/2): the series then only corrects f. e ln 2 is
 * added in two parts, of which the first has zeros at its end and is exact for every e.
 *
 * Exponential. With x = k ln 2 + r, |r| <= ln 2 / 2, e^x is 2^k times the Taylor series
 * of e^r to r^17, which leaves out 1e-24.
 *
 * Rejected: libm, whose last bits differ between systems; rational or minimax
 * coefficients, which save two products and have to be believed, while these series can
 * be checked by reading. */
#include "geom/elementary.h"

#include <math.h>

#include "geom/vec.h"

/* atan(k / 8). */
static const double ANGLES[9] = {
    0.0,
    0.12435499454676144,
    0.24497866312686414,
    0.35877067027057225,
    0.46364760900080609,
    0.55859931534356244,
    0.64350110879328437,
    0.71882999962162453,
    0.78539816339744828,
};

/* atan z by its series. Pre: |z| <= 1/16. */
static double small_angle(double z)
{
    double w = z * z;
    double tail = 1.0 / 11.0 - w * (1.0 / 13.0);
    tail = 1.0 / 7.0 - w * (1.0 / 9.0 - w * tail);
    tail = 1.0 / 3.0 - w * (1.0 / 5.0 - w * tail);
    return z - z * (w * tail);
}

double arctangent(double y, double x)
{
    double high = fabs(y), wide = fabs(x);
    double larger = high > wide ? high : wide;
    if (larger == 0.0)
        return 0.0;
    double t = (high > wide ? wide : high) / larger;
    int k = (int)(8.0 * t + 0.5);
    double c = 0.125 * k;
    double angle = ANGLES[k] + small_angle((t - c) / (1.0 + c * t));
    if (high > wide)
        angle = 0.5 * PI - angle;
    if (x < 0.0)
        angle = PI - angle;
    return y < 0.0 ? -angle : angle;
}

/* 2 artanh(s) / s - 2, by its series. Pre: w = s^2 < 0.0295. */
static double artanh_tail(double w)
{
    double sum = 2.0 / 21.0;
    for (int k = 19; k >= 3; k -= 2)
        sum = 2.0 / k + w * sum;
    return w * sum;
}

/* ln 2; the first part has zeros at its end. */
static const double LN2_HIGH = 0.6931471803691238, LN2_LOW = 1.9082149292705877e-10;

double logarithm(double x)
{
    static const double SQRT_HALF = 0.70710678118654752440;
    int exponent;
    double m = frexp(x, &exponent);
    if (m < SQRT_HALF) {
        m *= 2.0;
        exponent--;
    }
    double f = m - 1.0, s = f / (2.0 + f), half = 0.5 * f * f;
    double correction = half - s * (half + artanh_tail(s * s));
    return exponent * LN2_HIGH + (f - (correction - exponent * LN2_LOW));
}

double exponential(double x)
{
    int k = (int)(x / (LN2_HIGH + LN2_LOW) + (x < 0.0 ? -0.5 : 0.5));
    double r = x - k * LN2_HIGH - k * LN2_LOW, sum = 0.0;
    for (int n = 17; n >= 1; n--)
        sum = (1.0 + sum) * r / n;
    return ldexp(1.0 + sum, k);
}
