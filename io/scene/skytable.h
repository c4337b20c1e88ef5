/* Tables of sky radiances by direction: Tregenza's 145 patches, or Reinhart's parts of
 * them, as Radiance's gendaymtx and genskyvec print them. */
#ifndef IO_SCENE_SKYTABLE_H
#define IO_SCENE_SKYTABLE_H

#include <stdbool.h>

#include "geom/error.h"
#include "geom/vec.h"
#include "io/scene/text.h"

struct sky_table {
    struct rgb *radiances; /* [count], W/m^2/sr, from the horizon to the zenith */
    int64_t count;         /* 1 + 144 parts^2 */
    int parts;             /* along a side of Tregenza's patches */
};

/* Reads numbers, one or three (red, green, blue) for each patch: first the ground, which
 * may be left out and is passed over, then rows of patches upwards, each from the north
 * over the east, and the zenith. Lines of words before the first number are a heading.
 * To be freed with sky_table_free(), also after an error.
 * Errors: "FILE:LINE: REASON", EXIT_USAGE: words, negative numbers; a number of numbers
 * that no such table has. */
bool sky_table_read(struct sky_table *table, const char *path, struct error *error);
bool sky_table_of_text(struct sky_table *table, struct text *text, struct error *error);
void sky_table_free(struct sky_table *table);

/* Returns the radiance of a direction, of any length, above the horizon. */
struct rgb sky_table_radiance(const struct sky_table *table, double east, double north,
                              double up);

#endif
