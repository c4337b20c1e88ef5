/* The error of the last call of a reader, and what a test expects of it. */
#ifndef TESTS_REFUSAL_H
#define TESTS_REFUSAL_H

#include <string.h>

#include "geom/error.h"
#include "tests/tap.h"

static struct error error;

/* Forgets the error, as every call needs it. */
static inline void forget_error(void)
{
    error = (struct error){EXIT_DONE, ""};
}

/* True if the input is refused (not `good`), with exactly this line. */
static inline bool is_refused_as(bool good, const char *line)
{
    bool right = !good && error.code == EXIT_USAGE && strcmp(error.text, line) == 0;
    if (!right)
        printf("# expected '%s', got '%s'\n", line, error.text);
    return right;
}

static inline void check_error(bool good, const char *line)
{
    tap_ok(is_refused_as(good, line), "%s", line);
}

/* True if the error has this code, and its line goes on behind PATH and `start` with a
 * reason of the system's. */
static inline bool error_is_of_system(int code, const char *path, const char *start)
{
    size_t length = strlen(path), more = strlen(start);
    return error.code == code && strncmp(error.text, path, length) == 0 &&
           strncmp(error.text + length, start, more) == 0 && error.text[length + more];
}

#endif
