/* Reading Wavefront OBJ scenes with their MTL materials.
 *
 * Understood: v (what stands behind three coordinates, weights or colours, is passed over), vn
 * (for smooth shading), f (v, v/vt, v//vn, v/vt/vn, negative indices, polygons), usemtl, mtllib,
 * o, g; in MTL files newmtl, Kd (the reflectance rho) and Ke (the emitted radiosity E, W/m^2).
 * An o or g line gives the faces behind it, up to the next one, to the group of the name that is
 * the rest of the line; faces before any such line, or behind one without a name, are in the group
 * "default". Groups are numbered by their first faces.
 * Points, lines, texture coordinates and what only programs want to know are passed over, other
 * keywords too, but counted: free-form surfaces are among them. Lines may end in LF or CRLF and go on after a backslash. */
#ifndef IO_SCENE_OBJ_H
#define IO_SCENE_OBJ_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/scene/text.h"

/* What was read with a repair, for one warning per kind. */
struct obj_repairs {
    struct text_missing materials; /* names used but defined nowhere: neutral grey instead */
    struct text_missing libraries; /* mtllib files that could not be opened */
    int64_t bad_normals;       /* corners of faces whose vn is absent or has no direction: none */
    int64_t transparent;       /* used materials with d or Tr for transparency: opaque */
    int64_t textured;          /* used materials with map_Kd: of one colour */
    int64_t unknown_lines;     /* lines with keywords that are not known: passed over */
    long first_unknown;        /* the number of the first such line */
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
