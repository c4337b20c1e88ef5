/* Being asked to stop.
 *
 * The handler sets a flag and nothing else, so signals may come inside MPI. The long
 * loops of all layers look at the flag (geom/stop.h). Ranks tell each other of the signal
 * in exchanges made anyway (before each level of refinement, with each vote, when they
 * agree on errors), so that all stop in the same place, wherever the signal went: mpiexec
 * passes it on to all ranks, kill to one. A signal ignored by the shell stays ignored, as
 * for a job in the background.
 *
 * The system begins a system call again after a signal, since MPI is not made for calls
 * ending early. While a file is read there is no MPI, and calls end: a pipe without a
 * writer does not keep the program from ending. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#define HAVE_SIGACTION 1
#endif

#include "geom/signals.h"

#include <signal.h>
#include <stddef.h>
#ifdef HAVE_SIGACTION
#include <unistd.h>
#endif

#include "geom/stop.h"

/* Signals to stop a run: of users, of closing terminals, of batch systems when time is
 * nearly up. */
static const struct {
    int number;
    const char *name;
} STOPS[] = {
    {SIGTERM, "SIGTERM"}, {SIGINT, "SIGINT"},
#ifdef SIGHUP
    {SIGHUP, "SIGHUP"},
#endif
#ifdef SIGXCPU
    {SIGXCPU, "SIGXCPU"},
#endif
#ifdef SIGUSR1
    {SIGUSR1, "SIGUSR1"},
#endif
#ifdef SIGALRM
    {SIGALRM, "--time"},
#endif
};
enum { STOP_COUNT = sizeof STOPS / sizeof STOPS[0] };

static volatile sig_atomic_t seen;

static void remember(int number)
{
    seen = number;
}

#ifdef HAVE_SIGACTION
/* A second signal has its usual effect, but of SIGXCPU, which then comes each second. */
static int flags_of(int number, bool restarts)
{
    return (int)((number == SIGXCPU ? 0 : SA_RESETHAND) | (restarts ? SA_RESTART : 0));
}

static void catch_once(int number)
{
    struct sigaction before, action = {.sa_handler = remember};
    action.sa_flags = flags_of(number, true);
    sigemptyset(&action.sa_mask);
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN)
        sigaction(number, &action, NULL);
}

/* Unless the signal has come already, or is ignored. */
static void set_restart(int number, bool restarts)
{
    struct sigaction action;
    if (sigaction(number, NULL, &action) != 0 || action.sa_handler != remember)
        return;
    action.sa_flags = flags_of(number, restarts);
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
    for (int i = 0; i < STOP_COUNT; i++)
        catch_once(STOPS[i].number);
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
    for (int i = 0; i < STOP_COUNT; i++)
        set_restart(STOPS[i].number, !ends);
}

int signals_seen(void)
{
    return stop_is_asked() ? (int)seen : 0;
}

void signals_after(int seconds)
{
#ifdef HAVE_SIGACTION
    alarm((unsigned)seconds);
#else
    (void)seconds;
#endif
}

const char *signals_name(int number)
{
    for (int i = 0; i < STOP_COUNT; i++)
        if (STOPS[i].number == number)
            return STOPS[i].name;
    return "a signal";
}
