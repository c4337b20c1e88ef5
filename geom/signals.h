/* Being asked to stop: SIGTERM, SIGINT, SIGHUP, SIGXCPU and SIGUSR1. */
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

/* The signal received by this rank, 0: none. */
int signals_seen(void);

/* "SIGTERM" and so on. */
const char *signals_name(int number);

#endif
