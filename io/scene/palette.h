/* Different materials, numbered in order of appearance. */
#ifndef IO_SCENE_PALETTE_H
#define IO_SCENE_PALETTE_H

#include <stdint.h>

#include "geom/scene.h"

/* Starts as {0}. */
struct palette {
    struct material *materials; /* [count], all different */
    int32_t count;
    int64_t capacity;           /* of materials */
    int32_t *slots;             /* hash table: 0, or the number of a material plus 1 */
    int64_t slot_count;         /* a power of two, at least twice count */
};

/* Returns the number of the material, added if new. Pre: all its values are finite. */
int32_t palette_add(struct palette *palette, const struct material *material);
void palette_free(struct palette *palette);

#endif
