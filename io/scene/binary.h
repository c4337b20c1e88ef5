/* Binary files: whole in memory, read from a position on, and numbers in either byte
 * order. */
#ifndef IO_SCENE_BINARY_H
#define IO_SCENE_BINARY_H

#include <stdbool.h>
#include <stdint.h>

#include "geom/error.h"
#include "io/scene/source.h"

struct binary {
    const char *path;   /* borrowed from its source */
    char *data;         /* [size + 1] with a zero behind the last byte */
    int64_t size;       /* bytes */
    int64_t position;   /* of the next byte to read */
    long line;          /* number of the text line at `position`, from 1 */
};

/* Reads an open file, which has to begin with one of the words of `magic`, if there
 * are any. Owned by the caller until binary_free(), which is allowed (not needed) after a
 * failure.
 * Errors: "PATH: cannot read: REASON"; "PATH: not KIND". Both ask for EXIT_USAGE. */
bool binary_read(struct binary *binary, struct source *source, const char *magic,
                 const char *kind, struct error *error);

void binary_free(struct binary *binary);

/* Returns the number of bytes from the position to the end. */
int64_t binary_left(const struct binary *binary);

/* True if only blanks and line ends are left. */
bool binary_is_over(const struct binary *binary);

/* Returns the unsigned number in `count` (1 to 8) bytes at `at`, most or least
 * significant first. */
uint64_t binary_integer(const char *at, int count, bool big_endian);

/* Return the same bits as a signed number, as a float and as a double. */
int64_t binary_signed(const char *at, int count, bool big_endian);
float binary_float(const char *at, bool big_endian);
double binary_double(const char *at, bool big_endian);

#endif
