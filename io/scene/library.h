/* The material libraries that the mtllib lines of an OBJ file name. */
#ifndef IO_SCENE_LIBRARY_H
#define IO_SCENE_LIBRARY_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/scene/mtl.h"
#include "io/scene/text.h"

/* Reads the libraries named in `rest`, the rest of the current mtllib line of `obj`, into
 * the table; names are relative to the folder of `obj`, or to the current one if `obj` is
 * /dev/stdin or /dev/fd/N. `tried` has the names of earlier lines, which are skipped;
 * starts as {0} and is the caller's. `lost` counts the names of files that do not exist;
 * the paths of the others go to `files`, unless NULL.
 * Errors: those of mtl_read(); too many names. EXIT_USAGE. */
bool library_read(struct mtl_table *table, struct text_names *tried,
                  const struct text *obj, char *rest, struct text_missing *lost,
                  struct text_names *files, struct error *error);

#endif
