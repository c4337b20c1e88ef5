/* The state of a run, in a file and back. */
#ifndef TOOLS_STORED_H
#define TOOLS_STORED_H

#include "io/run/store.h"
#include "tools/run.h"

/* Collective. Writes the state after a pass. False on an error, on all ranks. */
bool stored_save(struct run *run, enum store_kind kind, const char *path);

/* Collective. Reads a state. Pre: homes are not assigned. False on an error, on all
 * ranks. */
bool stored_load(struct run *run, enum store_kind kind, const char *path);

/* Collective. If the scene is a stored solution, makes run->solver with its light, and
 * returns true. */
bool stored_light(struct run *run);

#endif
