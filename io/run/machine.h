/* The machine that this process runs on. */
#ifndef IO_RUN_MACHINE_H
#define IO_RUN_MACHINE_H

#include <stdint.h>

/* Returns the memory that the system lets all its processes use together, bytes; 0:
 * unknown. */
int64_t machine_memory(void);

/* Returns the lowest limit of the control groups that the process is in, bytes; 0: none.
 * `root` is the folder that /proc and /sys lie in, "" but for tests. */
int64_t machine_groups(const char *root);

/* Returns the part of the address space that ulimit leaves this process now, bytes, at
 * least 1; 0: it has no limit. */
int64_t machine_room(void);

#endif
