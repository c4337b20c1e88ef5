/* Numbers in short form, for links: there are many of them.
 *
 *     float    s eeeeeeee mmmmmmmmmmmmmmmmmmmmmmm
 *     8 bits        eeeee mmm                      1 to 2^32, within 1/8, rounded up */
#ifndef RAD_COMPACT_H
#define RAD_COMPACT_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* The largest float <= x. Pre: 0 <= x <= 1e38. */
static inline float float_below(double x)
{
    float f = (float)x;
    return (double)f > x ? nextafterf(f, 0.0f) : f;
}

/* Pre: 1 <= x; above 1.875 * 2^31, x counts as this number. */
static inline uint8_t compact8(double x)
{
    float f = (float)fmin(x, 4e9);
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return (uint8_t)(((bits + 0xfffffu) >> 20) - 127 * 8); /* at most 255, for 4e9 */
}

static inline double expand8(uint8_t compact)
{
    uint32_t bits = (uint32_t)(compact + 127 * 8) << 20;
    float f;
    memcpy(&f, &bits, sizeof f);
    return (double)f;
}

#endif
