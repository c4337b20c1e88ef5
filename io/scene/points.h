/* Points with normals, at which light is asked for. */
#ifndef IO_SCENE_POINTS_H
#define IO_SCENE_POINTS_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/vec.h"
#include "io/scene/text.h"

struct sensor {
    struct vec3 at;     /* input units */
    struct vec3 normal; /* of length 1 */
};

struct points {
    struct sensor *sensors; /* [count] */
    int64_t count, capacity;
};

/* Reads lines of six numbers x y z nx ny nz, with blanks, commas or semicolons between; #
 * begins a comment, and a first line of words is a heading. To be freed with
 * points_free(), also after an error.
 * Errors: "FILE:LINE: REASON", EXIT_USAGE: other lines, a normal of length 0; no
 * point. */
bool points_read(struct points *points, const char *path, struct error *error);
bool points_of_text(struct points *points, struct text *text, struct error *error);
void points_free(struct points *points);

#endif
