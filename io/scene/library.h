/* The material libraries of an OBJ file: which files its mtllib lines mean. */
#ifndef IO_SCENE_LIBRARY_H
#define IO_SCENE_LIBRARY_H

#include <stdbool.h>

#include "geom/error.h"
#include "io/scene/mtl.h"
#include "io/scene/text.h"

/* Reads what `rest`, the rest of the present mtllib line of `obj`, names, relative to the folder of
 * `obj`, into the table. `tried` are the names of earlier lines, which are passed over; it starts
 * as {0} and is the caller's. Names of files that do not exist are counted in `lost`.
 * Errors: those of mtl_read(); too many names. EXIT_USAGE. */
bool library_read(struct mtl_table *table, struct text_names *tried, const struct text *obj,
                  char *rest, struct text_missing *lost, struct error *error);

#endif
