/* The machine that this process runs on. */
#ifndef IO_RUN_MACHINE_H
#define IO_RUN_MACHINE_H

#include <stdint.h>

/* Bytes of memory that the system would let its processes use together, 0 if it does not tell. */
int64_t machine_memory(void);

#endif
