/* Laying out an object's arrays one after the other in a block of memory, for others to
 * look at: processes with the block at another address, or with a copy of its bytes.
 *
 *     struct pack count = {0};              struct pack write = {block, 0, true};
 *     thing_pack(thing, &count);            thing_pack(thing, &write);
 *     block = ... count.bytes ...           struct pack read = {block, 0, false};
 *                                           view = thing_view(&read);
 *
 * An object's head, its struct, goes before its arrays; pointers in the head mean nothing
 * in the block. */
#ifndef GEOM_PACK_H
#define GEOM_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

enum { PACK_ALIGNMENT = 64 }; /* bytes, a cache line: of the block and each array */

struct pack {
    char *block;  /* NULL: bytes are only counted */
    size_t bytes; /* up to here the block is packed or read */
    bool writes;
};

/* Where the next array of `bytes` bytes is in the block, NULL when counting. A writing
 * pack copies `array` there. */
static inline void *pack_array(struct pack *pack, const void *array, size_t bytes)
{
    char *at = pack->block ? pack->block + pack->bytes : NULL;
    if (pack->writes && array && bytes > 0)
        memcpy(at, array, bytes);
    pack->bytes += (bytes + PACK_ALIGNMENT - 1) / PACK_ALIGNMENT * PACK_ALIGNMENT;
    return at;
}

/* Does so with the `count` elements behind the pointer `array` of a head, which then
 * points to their place. */
#define PACK(pack, array, count) \
    ((array) = pack_array(pack, array, (size_t)(count) * sizeof *(array)))

#endif
