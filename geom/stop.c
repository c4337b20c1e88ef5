/* Being asked to stop.
 *
 * Loops that may take seconds ask before each step of a millisecond or less whether they
 * are to break off. The result of such a loop is incomplete: it can be packed, sent and
 * freed, and nothing else may be done with it. Readers and writers of files end with an
 * error instead. Since the request is never taken back, a caller that asks at the end of
 * a phase knows of each loop that broke off in it.
 *
 * The question has one place in the process, like the handler of exhausted memory
 * (geom/alloc.c). Rejected: handing it down as an argument, through some forty functions
 * that have no other use for it. */
#include "geom/stop.h"

static bool (*is_asked)(void);

void stop_when(bool (*asked)(void))
{
    is_asked = asked;
}

bool stop_is_asked(void)
{
    return is_asked && is_asked();
}

bool stop_check(struct error *error)
{
    return !stop_is_asked() || error_set(error, EXIT_FAILED, "stopped");
}
