/* The state of one run. Errors of the user or the system are values (geom/error.h) on
 * which all ranks agree after each phase; rank 0 prints them once. */
#include "tools/run.h"

#include <stdarg.h>
#include <stdio.h>

#include "geom/stop.h"
#include "geom/signals.h"

void run_say(struct run *run, const char *format, ...)
{
    if (run->comm.rank != 0 || run->options.quiet)
        return;
    progress_view_clear(&run->progress);
    va_list arguments;
    va_start(arguments, format);
    fputs("phr: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

bool run_stopped(struct run *run, int signal)
{
    const char *path = run->kept;
    return error_set(&run->error, EXIT_FAILED, "stopped by %s%s%s", signals_name(signal),
                     path ? "; go on with --resume " : "", path ? path : "");
}

bool run_agree(struct run *run)
{
    if (run->error.code != EXIT_DONE && signals_seen() != 0) {
        run->error = (struct error){.code = EXIT_DONE};
        run_stopped(run, signals_seen());
    }
    return comm_agree(&run->comm, &run->error);
}

bool run_goes_on(struct run *run)
{
    stop_check(&run->error);
    return run_agree(run);
}
