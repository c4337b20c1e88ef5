/* A tree as bytes: structure bits and leaf values, without IDs.
 *
 * Of a root: one bit for each patch, depth first, children in order, 1 = split, 0 = leaf (least
 * significant bit first, padded to whole bytes); then for each leaf in the same order its
 * radiosity, three IEEE 754 doubles, least significant byte first. So the bytes are the same on
 * every rank and machine: they give the checksum of the solution. */
#ifndef RAD_TREECODE_H
#define RAD_TREECODE_H

#include <stdint.h>

#include "rad/patch.h"

struct bytes {
    uint8_t *data; /* [count] */
    int64_t count, capacity;
};

void bytes_append(struct bytes *bytes, uint8_t byte);
void bytes_free(struct bytes *bytes);

/* Appends the tree of a root. */
void tree_encode(const struct forest *forest, int32_t root, struct bytes *bytes);

/* FNV-1a hash of all trees, roots in order: the same on any number of ranks. */
uint64_t forest_checksum(const struct forest *forest);

#endif
