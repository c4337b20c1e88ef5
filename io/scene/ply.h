/* Reading scenes from PLY meshes, as text or binary in either byte order.
 *
 * Vertices are x y z in any types. Faces have corners (vertex_indices or vertex_index),
 * and polygons are cut into triangles as in OBJ files; `tristrips` are triangles. Faces
 * or else vertices may have `red green blue`, or such a name as in plyfile.c, taken as
 * linear reflectances: an integer type counts in 255ths (16 bits: in 65535ths), float and
 * double as they are. A face without a colour has the mean colour of its corners; in a
 * file without colours all faces are neutral grey, 0.5. Faces may have `emission_r
 * emission_g emission_b`, the emitted radiosity E in W/m^2. Other elements and properties
 * are skipped, and named in the file's `passed`. */
#ifndef IO_SCENE_PLY_H
#define IO_SCENE_PLY_H

#include <stdbool.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/scene/plyfile.h"

/* True if an open file is to be read as PLY: its name ends in .ply; or its name does not
 * end in .obj, and the file begins as a PLY file does. */
bool ply_is_meant(const struct source *source);

/* Reads a file whose header is read, and which stays open. Returns a scene before
 * scene_prepare() (positions in input units), of one group, with one material for each
 * different pair of reflectance and emission; or NULL with `error` set (EXIT_USAGE):
 * "FILE:LINE: REASON" in text, else "FILE: face 3: REASON", counted from 0.
 * Errors: those of io/scene/plyfile.h; no x y z, no faces, a face with fewer than three
 * corners, a corner out of range, a negative colour or emission. */
struct scene *ply_of_file(struct ply_file *file, struct error *error);

#endif
