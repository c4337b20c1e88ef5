/* FNV-1a, 64 bits: tells apart files and scenes differing by accident. A changed byte
 * always changes the hash, but no attacker is kept from making two files look alike. */
#ifndef GEOM_HASH_H
#define GEOM_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "geom/little.h"
#include "geom/vec.h"

#define HASH_START UINT64_C(14695981039346656037)

/* Goes on with the hash of the bytes before, over `count` more. */
static inline uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const uint8_t *at = bytes;
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ at[i]) * UINT64_C(1099511628211);
    return hash;
}

/* The same for `count` numbers, on any machine. */
static inline uint64_t hash_doubles(uint64_t hash, const double *values, int count)
{
    uint8_t bytes[8];
    for (int i = 0; i < count; i++) {
        little_put_double(bytes, values[i]);
        hash = hash_bytes(hash, bytes, sizeof bytes);
    }
    return hash;
}

/* 2^64 by the golden ratio: seeds differing by multiples of this are far apart. */
#define HASH_STEP UINT64_C(0x9E3779B97F4A7C15)

/* Mixes all bits: the finaliser of splitmix64 (Steele et al. 2014). */
static inline uint64_t hash_finish(uint64_t bits)
{
    bits = (bits ^ bits >> 30) * UINT64_C(0xBF58476D1CE4E5B9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94D049BB133111EB);
    return bits ^ bits >> 31;
}

/* A bijection of 64 bits after which no bit tells anything about another (splitmix64). */
static inline uint64_t hash_mix(uint64_t bits)
{
    return hash_finish(bits + HASH_STEP);
}

/* A number in 0 <= u < 1 from a seed. */
static inline double hash_unit(uint64_t seed)
{
    return (double)(hash_mix(seed) >> 11) * 0x1p-53;
}

/* For tables of points; the sign of zeros does not count. */
static inline uint64_t hash_point(uint64_t seed, struct vec3 x)
{
    const double values[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* -0 becomes 0 */
    uint64_t hash = seed;
    for (int k = 0; k < 3; k++) {
        uint64_t bits;
        memcpy(&bits, &values[k], sizeof bits);
        hash = (hash ^ bits) * HASH_STEP;
        hash ^= hash >> 29;
    }
    return hash;
}

#endif
