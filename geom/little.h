/* Numbers as bytes, least significant first, the same on every machine. Floating point is
 * IEEE 754's. */
#ifndef GEOM_LITTLE_H
#define GEOM_LITTLE_H

#include <stdint.h>
#include <string.h>

static inline void little_put32(uint8_t bytes[4], uint32_t value)
{
    for (int k = 0; k < 4; k++)
        bytes[k] = (uint8_t)(value >> (8 * k));
}

static inline uint32_t little_get32(const uint8_t bytes[4])
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static inline void little_put64(uint8_t bytes[8], uint64_t value)
{
    little_put32(bytes, (uint32_t)(value & UINT32_MAX));
    little_put32(bytes + 4, (uint32_t)(value >> 32));
}

static inline uint64_t little_get64(const uint8_t bytes[8])
{
    return (uint64_t)little_get32(bytes) | (uint64_t)little_get32(bytes + 4) << 32;
}

static inline void little_put_double(uint8_t bytes[8], double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    little_put64(bytes, bits);
}

static inline double little_get_double(const uint8_t bytes[8])
{
    uint64_t bits = little_get64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline void little_put_float(uint8_t bytes[4], float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    little_put32(bytes, bits);
}

static inline float little_get_float(const uint8_t bytes[4])
{
    uint32_t bits = little_get32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
