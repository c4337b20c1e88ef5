/* Reading Wavefront OBJ scenes with their MTL materials.
 *
 * Understood: v, f (v, v/vt, v//vn, v/vt/vn, negative indices, polygons), usemtl, mtllib,
 * o, g; in MTL files newmtl, Kd (the reflectance rho) and Ke (the emitted radiosity E, W/m^2).
 * An o or g line gives the faces behind it, up to the next one, to the group of the name that is
 * the rest of the line; faces before any such line, or behind one without a name, are in the group
 * "default". Groups are numbered by their first faces.
 * Other keywords are passed over. Lines may end in LF or CRLF and go on after a backslash. */
#ifndef IO_OBJ_H
#define IO_OBJ_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/text.h"

/* What was read with a repair, for one warning per kind. */
struct obj_repairs {
    int64_t missing_materials; /* names used but defined nowhere: neutral grey instead */
    int64_t missing_libraries; /* mtllib files that could not be opened */
    char first_missing[128];   /* the first such name, for the message */
};

/* Reads `path` and the material libraries that it names (relative to it).
 * Returns a scene that is not prepared yet (positions in input units), or NULL with `error`
 * filled as "FILE:LINE: what is wrong" (EXIT_USAGE).
 * Errors: a file that cannot be read or has no faces, malformed numbers, NaN and infinities,
 * indices out of range, faces with fewer than three corners, negative reflectance or emission. */
struct scene *obj_read(const char *path, struct obj_repairs *repairs, struct error *error);

/* The same for a text that is in memory. Takes it over: it is freed. */
struct scene *obj_of_text(struct text *text, struct obj_repairs *repairs, struct error *error);

#endif
