/* Being asked to stop: SIGTERM, SIGINT, SIGHUP, SIGXCPU, SIGUSR1 and SIGALRM. */
#ifndef GEOM_SIGNALS_H
#define GEOM_SIGNALS_H

#include <stdbool.h>

/* From here on the first of these signals is remembered and stops loops asking
 * stop_is_asked(); a second of its kind has its usual effect, but of SIGXCPU; a write
 * beyond the limit of a file's size (SIGXFSZ) or to a pipe without readers (SIGPIPE) is
 * an error like a full disk. */
void signals_catch(void);

/* Whether a signal ends a waiting system call, such as for a pipe, with an error; at
 * first not. Pre: no MPI is called while signals end calls. */
void signals_end_calls(bool ends);

/* The signal received by this rank, 0: none, or it is heeded (geom/stop.h). */
int signals_seen(void);

/* Sends SIGALRM, one of these signals, after this time, at least a second. */
void signals_after(int seconds);

/* "SIGTERM" and so on; "--time" for SIGALRM. */
const char *signals_name(int number);

#endif
