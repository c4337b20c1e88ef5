/* The machine that this process runs on. */
#ifndef IO_RUN_MACHINE_H
#define IO_RUN_MACHINE_H

#include <stdint.h>

/* Returns the memory that the system lets all its processes use together, bytes; 0:
 * unknown. */
int64_t machine_memory(void);

#endif
