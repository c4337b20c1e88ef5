/* Tests that print TAP lines ("ok 3 - name") and whose exit status is the verdict. */
#ifndef TESTS_TAP_H
#define TESTS_TAP_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "geom/alloc.h"

static int tap_count, tap_failed;

/* One test: `passed`, and a name as a printf format. Returns `passed`. */
#ifdef __GNUC__
__attribute__((format(printf, 2, 3), unused))
#endif
static bool tap_ok(bool passed, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tap_count++;
    tap_failed += !passed;
    printf("%s %d - ", passed ? "ok" : "not ok", tap_count);
    vprintf(format, arguments);
    printf("\n");
    fflush(stdout);
    va_end(arguments);
    return passed;
}

/* To end main() with: the leak test, the plan, the verdict. */
static inline int tap_done(void)
{
    tap_ok(alloc_balance() == 0, "every block is freed");
    printf("1..%d\n", tap_count);
    return tap_failed ? 1 : 0;
}

#endif
