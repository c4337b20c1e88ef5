/* Bytes in memory that are read as a file. */
#ifndef TESTS_MEMORY_H
#define TESTS_MEMORY_H

#include <stdint.h>
#include <stdio.h>

#include "io/scene/source.h"

FILE *fmemopen(void *bytes, size_t size, const char *mode); /* POSIX */

static inline FILE *file_of_bytes(const void *bytes, size_t size)
{
    return size > 0 ? fmemopen((void *)(uintptr_t)bytes, size, "rb") : tmpfile();
}

/* To be closed by source_close(). */
static inline bool source_of_bytes(struct source *source, const char *path,
                                   const void *bytes, size_t size, struct error *error)
{
    return source_of_file(source, path, file_of_bytes(bytes, size), error);
}

#endif
