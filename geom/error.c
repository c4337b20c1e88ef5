/* The error value; see geom/error.h. */
#include "geom/error.h"

#include <stdarg.h>
#include <stdio.h>

const char *error_program = "phr";

bool error_set(struct error *error, int code, const char *format, ...)
{
    if (error->code != EXIT_DONE)
        return false;
    error->code = code;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
    for (char *c = error->text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = '?';
    return false;
}
