/* Errors of the user or the system as values: a text and an exit code.
 *
 * A function that can fail so takes a `struct error *`, fills the error in and returns
 * false. Nothing is printed where the error is found: the ranks first agree on the error,
 * then rank 0 prints the text, behind the name of the program. */
#ifndef GEOM_ERROR_H
#define GEOM_ERROR_H

#include <stdbool.h>
#include <stdint.h>

enum {
    EXIT_DONE = 0,  /* the computation ended well */
    EXIT_FAILED = 1, /* a failure: diverged, out of memory, cannot write */
    EXIT_USAGE = 2  /* bad usage or bad input */
};

struct error {
    int32_t code;   /* EXIT_DONE while nothing is wrong */
    char text[508]; /* one line, without "phr: " and without the newline */
};

/* The name of the program, "phr" unless its main() says otherwise. */
extern const char *error_program;

/* Fills `error` from a printf format unless there is an error already (the first one
 * counts); control characters of the text (which may quote a file) become '?'. Returns
 * false, so a caller can write `return error_set(...)`. */
#ifdef __GNUC__
__attribute__((format(printf, 3, 4)))
#endif
bool error_set(struct error *error, int code, const char *format, ...);

#endif
