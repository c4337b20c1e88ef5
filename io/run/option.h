/* One option: its row of the table, and how its value is read into struct options. */
#ifndef IO_RUN_OPTION_H
#define IO_RUN_OPTION_H

#include <stdbool.h>
#include <stddef.h>

#include "geom/error.h"

struct argument;
struct options;

/* A row of the table of options. */
struct option {
    const char *name;
    const char *value;   /* name in the help; "" of a flag */
    const char *help;    /* a few words, the default in brackets; of a refused option, the
                            command for its work */
    bool (*set)(const struct argument *argument); /* NULL: refused */
    size_t offset;       /* of the field in struct options */
    double low, high;    /* inclusive range of a number */
    const char *choices; /* names, separated by bars, in the order of the field's enum */
};

/* An option on the command line, on its way to its field. */
struct argument {
    const struct option *option;
    const char *value; /* not looked at for a flag */
    struct options *options;
    void *field; /* the option's, of the options */
    struct error *error;
};

/* Set the field of an argument to its value. Errors: "--option: 'VALUE' is not ...",
 * EXIT_USAGE. Fields are a double (real; fraction: a number, or a percentage), an int
 * (integer; time, in seconds; choice, an enum counted from 0), an int64_t (bytes), a
 * struct sky (sky, sun), a path, once only (text), or a bool (flag). */
bool option_set_real(const struct argument *argument);
bool option_set_integer(const struct argument *argument);
bool option_set_choice(const struct argument *argument);
bool option_set_sky(const struct argument *argument);
bool option_set_sun(const struct argument *argument);
bool option_set_fraction(const struct argument *argument);
bool option_set_time(const struct argument *argument);
bool option_set_bytes(const struct argument *argument);
bool option_set_text(const struct argument *argument);
bool option_set_flag(const struct argument *argument);

/* For other kinds: sets the error, "--option: 'VALUE' is not KIND". Returns false. */
bool option_is_not(const struct argument *argument, const char *kind);

enum { DIGITS_ROOM = 64 };

/* Copies the first characters of a text. False if there is no room. */
bool option_copy_digits(const char *text, size_t length, char digits[DIGITS_ROOM]);

/* Writes the line "--option value" of a field that is no path and no int64_t. */
void option_write(const struct option *option, const void *field, char *line,
                  size_t room);

#endif
