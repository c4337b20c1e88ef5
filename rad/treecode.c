/* Trees as bytes; the format is in rad/treecode.h.
 *
 * Depth first order takes the place of IDs. Inner values are left out: they are means of leaf values. */
#include "rad/treecode.h"

#include <string.h>

#include "geom/alloc.h"

void bytes_append(struct bytes *bytes, uint8_t byte)
{
    bytes->data = alloc_reserve(bytes->data, &bytes->capacity, bytes->count + 1, 1);
    bytes->data[bytes->count++] = byte;
}

void bytes_free(struct bytes *bytes)
{
    alloc_free(bytes->data);
    *bytes = (struct bytes){0};
}

static void append_double(struct bytes *bytes, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    bytes->data = alloc_reserve(bytes->data, &bytes->capacity, bytes->count + 8, 1);
    for (int k = 0; k < 8; k++)
        bytes->data[bytes->count++] = (uint8_t)(bits >> (8 * k));
}

void tree_encode(const struct forest *forest, int32_t root, struct bytes *bytes)
{
    uint8_t byte = 0;
    int bit = 0;
    for (int32_t p = root; p >= 0; p = forest_next(forest, p, true)) {
        byte = (uint8_t)(byte | (patch_is_leaf(&forest->patches[p]) ? 0 : 1) << bit);
        if (++bit == 8) {
            bytes_append(bytes, byte);
            byte = 0;
            bit = 0;
        }
    }
    if (bit > 0)
        bytes_append(bytes, byte);
    for (int32_t p = root; p >= 0; p = forest_next(forest, p, true))
        if (patch_is_leaf(&forest->patches[p]))
            for (int c = 0; c < BANDS; c++)
                append_double(bytes, forest->patches[p].radiosity.band[c]);
}

uint64_t forest_checksum(const struct forest *forest)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    struct bytes bytes = {0};
    for (int32_t root = 0; root < forest->root_count; root++) {
        bytes.count = 0;
        tree_encode(forest, root, &bytes);
        for (int64_t i = 0; i < bytes.count; i++)
            hash = (hash ^ bytes.data[i]) * UINT64_C(1099511628211);
    }
    bytes_free(&bytes);
    return hash;
}
