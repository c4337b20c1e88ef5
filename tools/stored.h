/* The state of a run, in a file and back. */
#ifndef TOOLS_STORED_H
#define TOOLS_STORED_H

#include "io/run/store.h"
#include "tools/run.h"

/* Collective. Writes the state after a pass. A file that cannot be written is lost
 * (run_lose()), with a warning. False if the run is asked to stop, on all ranks. */
bool stored_save(struct run *run, enum store_kind kind, const char *path);

/* Collective. Before the final gather: makes the checkpoint that no pass has made, as of
 * a run resumed when finished, or tells the reason for none. False as above. */
bool stored_complete(struct run *run);

/* Collective. Reads a state. Pre: homes are not assigned. False on an error, on all
 * ranks. */
bool stored_load(struct run *run, enum store_kind kind, const char *path);

/* Collective. If the scene is a stored solution, makes run->solver with its light, and
 * returns true. */
bool stored_light(struct run *run);

#endif
