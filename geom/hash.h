/* FNV-1a, 64 bits: tells files and scenes apart that differ by accident. A changed byte always
 * changes it; it is no protection against those who want two files to look alike. */
#ifndef GEOM_HASH_H
#define GEOM_HASH_H

#include <stddef.h>
#include <stdint.h>

#define HASH_START UINT64_C(14695981039346656037)

/* The hash of what came before and `count` bytes more. */
static inline uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const uint8_t *at = bytes;
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ at[i]) * UINT64_C(1099511628211);
    return hash;
}

#endif
