/* Output files, written beside their place and renamed when they are whole. */
#ifndef IO_RUN_OUTPUT_H
#define IO_RUN_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "geom/error.h"

struct output {
    FILE *file;
    char *shown;     /* the path as given, for messages; owned */
    char *path;      /* the path with symbolic links resolved; owned */
    char *temporary; /* path of the new file; owned; NULL: written in place */
};

/* True if the file can be written: creates and removes the temporary file, so that a
 * wrong path is reported before the computation and not after it.
 * Errors: "PATH: cannot write: REASON", EXIT_FAILED. */
bool output_probe(const char *path, struct error *error);

/* Opens a new file PATH.N.tmp, or PATH itself if it is a device or a pipe. Symbolic links
 * are followed. */
bool output_open(struct output *output, const char *path, struct error *error);

/* Closes and renames. On any write error so far, or if `error` is already set, the new
 * file is removed and PATH stays as it was. Returns true if PATH has the new content. */
bool output_close(struct output *output, struct error *error);

/* Waits until all bytes written so far are on the disk: for files that have to outlive a
 * crash. */
void output_sync(struct output *output, struct error *error);

/* Write binary numbers, least significant byte first. */
void output_uint32(struct output *output, uint32_t value);
void output_float(struct output *output, float value);

/* Write them most significant byte first. */
void output_uint32_big(struct output *output, uint32_t value);
void output_float_big(struct output *output, float value);

#endif
