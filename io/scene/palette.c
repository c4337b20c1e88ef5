/* A hash table of materials, built like the names in io/scene/text.c: a scanned mesh may
 * have a colour for each face, and searching a list would take quadratic time. */
#include "io/scene/palette.h"

#include <string.h>

#include "geom/alloc.h"

static uint64_t mix(uint64_t sum, double value)
{
    uint64_t bits;
    value += 0.0; /* -0 becomes 0 */
    memcpy(&bits, &value, sizeof bits);
    sum = (sum ^ bits) * UINT64_C(0x9E3779B97F4A7C15);
    return sum ^ sum >> 32;
}

/* Returns the slot of a material, or the empty slot for a new one. */
static int32_t *find_slot(const struct palette *palette, const struct material *material)
{
    uint64_t mask = (uint64_t)palette->slot_count - 1, at = 0;
    for (int c = 0; c < BANDS; c++)
        at = mix(mix(at, material->reflectance.band[c]), material->emission.band[c]);
    at &= mask;
    while (palette->slots[at] &&
           !material_is_same(&palette->materials[palette->slots[at] - 1], material))
        at = (at + 1) & mask;
    return &palette->slots[at];
}

static void make_slots(struct palette *palette, int64_t slot_count)
{
    alloc_free(palette->slots);
    palette->slots = alloc_array((size_t)slot_count, sizeof *palette->slots);
    palette->slot_count = slot_count;
    for (int32_t i = 0; i < palette->count; i++)
        *find_slot(palette, &palette->materials[i]) = i + 1;
}

int32_t palette_add(struct palette *palette, const struct material *material)
{
    if (palette->slot_count < 2 * ((int64_t)palette->count + 1))
        make_slots(palette, palette->slot_count ? 2 * palette->slot_count : 16);
    int32_t *slot = find_slot(palette, material);
    if (*slot == 0) {
        RESERVE(palette->materials, &palette->capacity, (int64_t)palette->count + 1);
        palette->materials[palette->count] = *material;
        *slot = ++palette->count;
    }
    return *slot - 1;
}

void palette_free(struct palette *palette)
{
    alloc_free(palette->materials);
    alloc_free(palette->slots);
    *palette = (struct palette){0};
}
