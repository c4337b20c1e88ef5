/* Output files, written beside their place and renamed when whole. */
#ifndef IO_RUN_OUTPUT_H
#define IO_RUN_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "geom/error.h"

struct output {
    FILE *file;
    char *shown;     /* the path as given, for messages; owned */
    char *path;      /* the path behind symbolic links; owned */
    char *temporary; /* path of the new file; owned; NULL: a stream, whose bytes wait */
    char *bytes;     /* [size] of a stream, once flushed; owned by the system */
    size_t size;
};

/* True if the path leads to a device, a pipe or an open descriptor: "-" and /dev/stdout,
 * the standard output; /dev/stderr; /dev/fd/N. */
bool output_is_stream(const char *path);

/* True if the file can be written: creates and removes the temporary file, to report a
 * wrong path before the computation and not after. A stream is not opened. Errors: "PATH:
 * cannot write: REASON", EXIT_FAILED. */
bool output_probe(const char *path, struct error *error);

/* Opens a new file FILE.N.tmp, or phr.N.tmp where that name is too long, beside the file
 * at the end of the path, or memory for the bytes of a stream. Errors: as above. */
bool output_open(struct output *output, const char *path, struct error *error);

/* Puts the new file, of the old one's mode, in its place, and brings file and name to the
 * disk; or opens a stream, a named pipe when there is a reader, and writes the bytes. On
 * any write error so far, or if `error` is already set, the new file is removed, and the
 * old one or the stream stays as it was. Returns true if PATH has the new content.
 * A request to stop ends writing to a stream with an error. */
bool output_close(struct output *output, struct error *error);

/* The note in every picture and mesh of the process: lines of ASCII, each with its
 * newline; borrowed. Returned is "" before one is set. */
void output_set_note(const char *lines);
const char *output_note(void);

/* Writes these lines, `before` in front of each. */
void output_write_note(struct output *output, const char *before);

/* Write binary numbers, least significant byte first. */
void output_uint32(struct output *output, uint32_t value);
void output_float(struct output *output, float value);

/* Write binary numbers, most significant byte first. */
void output_uint32_big(struct output *output, uint32_t value);
void output_float_big(struct output *output, float value);

#endif
