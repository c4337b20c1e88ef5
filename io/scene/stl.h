/* Reading scenes from STL files, as text or binary.
 *
 * Each `solid` of a text file is a group, named by the rest of its line, or "solid 2", if
 * it is the second; a binary file is one group, "default". Normals are passed over: a
 * face's front is where its corners are counter-clockwise. All faces are neutral grey,
 * 0.5. */
#ifndef IO_SCENE_STL_H
#define IO_SCENE_STL_H

#include <stdbool.h>

#include "geom/error.h"
#include "geom/scene.h"
#include "io/scene/source.h"

/* True if the name of an open file ends in .stl. */
bool stl_is_meant(const struct source *source);

/* Reads an open file, which stays open. Returns a scene before scene_prepare() (positions
 * in input units), or NULL with `error` set (EXIT_USAGE): "FILE:LINE: REASON" in text,
 * else "FILE: face 3: REASON", counted from 0.
 * Errors: a file that cannot be read or has no faces; numbers that are malformed, NaN or
 * too large; a face with other than three corners; words of another format. */
struct scene *stl_of_source(struct source *source, struct error *error);

#endif
