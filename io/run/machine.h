/* The machine of this process. */
#ifndef IO_RUN_MACHINE_H
#define IO_RUN_MACHINE_H

#include <stdint.h>

/* Returns the memory allowed to all processes of the system together, bytes; 0:
 * unknown. */
int64_t machine_memory(void);

/* Returns the lowest limit of the control groups of the process, bytes; 0: none. `root`
 * is the folder of /proc and /sys, "" but for tests. */
int64_t machine_groups(const char *root);

/* Returns the part of the address space left to this process by ulimit now, bytes, at
 * least 1; 0: no limit. */
int64_t machine_room(void);

#endif
