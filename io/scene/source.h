/* Files read once, from their beginnings to their ends, so that pipes work. */
#ifndef IO_SCENE_SOURCE_H
#define IO_SCENE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "geom/error.h"

enum { SOURCE_START = 4, SOURCE_CHUNK = 65536 };

struct source {
    const char *path;             /* borrowed from the caller of source_open() */
    FILE *file;
    char start[SOURCE_START + 1]; /* the first bytes, and zeros behind */
    size_t start_count;           /* of these, in the file */
    size_t taken;                 /* of these, by source_read() */
};

/* Opens the file `path` and looks at its first bytes. To be closed, also after an error.
 * Errors: "PATH: cannot read: REASON", EXIT_USAGE. */
bool source_open(struct source *source, const char *path, struct error *error);
void source_close(struct source *source);

/* Does the same with a file named by another: a folder, a pipe or a device is refused, as
 * reading may never end. */
bool source_open_regular(struct source *source, const char *path, struct error *error);

/* Does the same with an open file, and takes the file over; NULL: fopen() could not open
 * one. */
bool source_of_file(struct source *source, const char *path, FILE *file,
                    struct error *error);

/* Reads up to SOURCE_CHUNK bytes, and puts their number, fewer at the end of the file
 * alone, into `*got`. Errors: as above; a request to stop. */
bool source_read(struct source *source, char *bytes, size_t *got, struct error *error);

#endif
