/* Being asked to stop.
 *
 * Loops that may take seconds ask before each step of a millisecond or less whether to
 * break off. The result of such a loop is incomplete: fit to be packed, sent and freed,
 * and for nothing else. Readers and writers of files end with an error instead. Since the
 * request is never taken back, a caller asking at the end of a phase knows of each loop
 * broken off before.
 *
 * The question has one place in the process, like the handler of exhausted memory
 * (geom/alloc.c). Rejected: handing the question down as an argument, through some forty
 * functions with no other use for it. */
#include "geom/stop.h"

static bool (*is_asked)(void);
static bool heeded;

void stop_when(bool (*asked)(void))
{
    is_asked = asked;
    heeded = false;
}

bool stop_is_asked(void)
{
    return !heeded && stop_was_asked();
}

void stop_heed(void)
{
    heeded = true;
}

bool stop_was_asked(void)
{
    return is_asked && is_asked();
}

bool stop_check(struct error *error)
{
    return !stop_is_asked() || error_set(error, EXIT_FAILED, "stopped");
}
