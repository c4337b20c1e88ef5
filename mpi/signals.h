/* Being asked to stop: SIGTERM and SIGINT. */
#ifndef MPI_SIGNALS_H
#define MPI_SIGNALS_H

#include "mpi/comm.h"

/* From here on the first SIGTERM or SIGINT is remembered and a second one has its usual effect; a write
 * beyond the limit of a file's size (SIGXFSZ) is an error like a full disk. */
void signals_catch(void);

/* The signal that this rank has got, 0: none. */
int signals_seen(void);

/* Collective. The largest number of a signal that any rank has got, 0: none. */
int signals_agree(const struct comm *comm);

/* "SIGTERM", "SIGINT". */
const char *signals_name(int number);

#endif
