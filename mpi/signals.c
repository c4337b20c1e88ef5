/* Being asked to stop.
 *
 * The handler sets a flag and nothing else, so it may come inside MPI; system calls are begun
 * again by the system. Ranks tell each other what they have seen in exchanges that there are anyway
 * (before each level of refinement, with each vote), so that all stop in the same place, wherever the
 * signal went: mpiexec passes it on to all ranks, kill to one. What the shell has set to be ignored
 * stays so, as for a job in the background. */
#if defined(__unix__) || defined(__APPLE__)
#define _XOPEN_SOURCE 700
#define HAVE_SIGACTION 1
#endif

#include "mpi/signals.h"

#include <signal.h>

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
#else
static void catch_once(int number)
{
    signal(number, remember); /* C99: the first one only, as a rule */
}
#endif

void signals_catch(void)
{
    catch_once(SIGTERM);
    catch_once(SIGINT);
#ifdef SIGXFSZ
    signal(SIGXFSZ, SIG_IGN);
#endif
}

int signals_seen(void)
{
    return (int)seen;
}

int signals_agree(const struct comm *comm)
{
    int own = signals_seen(), all;
    MPI_Request request;
    MPI_Iallreduce(&own, &all, 1, MPI_INT, MPI_MAX, comm->handle, &request);
    comm_wait(&request);
    return all;
}

const char *signals_name(int number)
{
    return number == SIGTERM ? "SIGTERM" : number == SIGINT ? "SIGINT" : "a signal";
}
