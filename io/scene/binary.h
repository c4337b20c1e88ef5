/* Binary files: whole in memory, with a place to read on from, and numbers in either byte
 * order. */
#ifndef IO_SCENE_BINARY_H
#define IO_SCENE_BINARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geom/error.h"

struct binary {
    const char *path;   /* borrowed from the caller of binary_read() */
    char *data;         /* [size], and a zero behind */
    int64_t size;       /* bytes */
    int64_t position;   /* where reading goes on */
    long line;          /* number of the text line at `position`, from 1 */
};

/* Reads the file `path`, which has to begin with `magic`. Owned by the caller until binary_free(),
 * which is allowed (not needed) after a failure.
 * Errors: "PATH: cannot read: REASON"; "PATH: not KIND". Both ask for EXIT_USAGE. */
bool binary_read(struct binary *binary, const char *path, const char *magic, const char *kind,
                struct error *error);

/* The same for a copy of `size` bytes that are in memory, as if they were the file `path`. */
bool binary_of_bytes(struct binary *binary, const char *path, const void *data, size_t size,
                     const char *magic, const char *kind, struct error *error);

void binary_free(struct binary *binary);

/* Bytes from the position to the end. */
int64_t binary_left(const struct binary *binary);

/* True if all that is left is blanks and line ends. */
bool binary_is_over(const struct binary *binary);

/* The unsigned number in `count` (1 to 8) bytes at `at`, most or least significant first. */
uint64_t binary_integer(const char *at, int count, bool big_endian);

/* The same bits as a number with a sign, as a float and as a double. */
int64_t binary_signed(const char *at, int count, bool big_endian);
float binary_float(const char *at, bool big_endian);
double binary_double(const char *at, bool big_endian);

#endif
