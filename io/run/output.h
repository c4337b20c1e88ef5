/* Output files, written beside their place and renamed when they are whole. */
#ifndef IO_RUN_OUTPUT_H
#define IO_RUN_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "geom/error.h"

struct output {
    FILE *file;
    char *shown;     /* the path as it was given, owned */
    char *path;      /* the path behind links, owned */
    char *temporary; /* owned; NULL when written in place (a device or a pipe) */
};

/* True if the file could be written: tried by creating what would be renamed later, so that a
 * wrong path is known before the computation and not after it.
 * Errors: "PATH: cannot write: REASON", EXIT_FAILED. */
bool output_probe(const char *path, struct error *error);

/* Opens a new file PATH.N.tmp, or PATH itself where it exists and is not a regular file. Links
 * are followed. */
bool output_open(struct output *output, const char *path, struct error *error);

/* Closes and renames. On any write error so far, or if `error` is already set, nothing is left
 * behind and PATH stays as it was. Returns whether PATH holds the new content. */
bool output_close(struct output *output, struct error *error);

/* Makes sure that what was written so far is on the disk and not only on its way: for files whose
 * whole point is to outlive a crash. */
void output_sync(struct output *output, struct error *error);

/* Binary numbers, byte by byte, least significant first, the same on every machine. */
void output_uint32(struct output *output, uint32_t value);
void output_float(struct output *output, float value);

#endif
