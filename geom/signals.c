/* Being asked to stop.
 *
 * The handler sets a flag and nothing else, so it may come inside MPI. The long loops of
 * all layers look at the flag (geom/stop.h). Ranks tell each other of it in exchanges
 * that there are anyway (before each level of refinement, with each vote, when they
 * agree on errors), so that all stop in the same place, wherever the signal went:
 * mpiexec passes it on to all ranks, kill to one. A signal that the shell has set to be
 * ignored stays so, as for a job in the background.
 *
 * The system begins system calls again that a signal has met, since MPI is not made for
 * calls that end early. While a file is read there is no MPI, and calls end: a pipe that
 * nobody writes to does not keep the program from ending. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#define HAVE_SIGACTION 1
#endif

#include "geom/signals.h"

#include <signal.h>
#include <stddef.h>

#include "geom/stop.h"

static volatile sig_atomic_t seen;

static void remember(int number)
{
    seen = number;
}

#ifdef HAVE_SIGACTION
static void catch_once(int number)
{
    struct sigaction before, action = {.sa_handler = remember};
    action.sa_flags = (int)(SA_RESTART | SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(number, &action, NULL);
}

/* Unless it has come already, or is ignored. */
static void set_restart(int number, bool restarts)
{
    struct sigaction action;
    if (sigaction(number, NULL, &action) != 0 || action.sa_handler != remember)
        return;
    action.sa_flags = (int)(SA_RESETHAND | (restarts ? SA_RESTART : 0));
    sigaction(number, &action, NULL);
}
#else
static void catch_once(int number)
{
    signal(number, remember); /* C99: the first one only, as a rule */
}

static void set_restart(int number, bool restarts)
{
    (void)number;
    (void)restarts;
}
#endif

static bool is_seen(void)
{
    return seen != 0;
}

void signals_catch(void)
{
    catch_once(SIGTERM);
    catch_once(SIGINT);
    stop_when(is_seen);
#ifdef SIGXFSZ
    signal(SIGXFSZ, SIG_IGN);
#endif
#ifdef SIGPIPE
    signal(SIGPIPE, SIG_IGN);
#endif
}

void signals_end_calls(bool ends)
{
    set_restart(SIGTERM, !ends);
    set_restart(SIGINT, !ends);
}

int signals_seen(void)
{
    return (int)seen;
}

const char *signals_name(int number)
{
    return number == SIGTERM ? "SIGTERM" : number == SIGINT ? "SIGINT" : "a signal";
}
