/* --dump: all patches, or all links, as text. */
#ifndef TOOLS_DUMP_H
#define TOOLS_DUMP_H

#include "tools/run.h"

/* Collective, after compute_light(). With --dump, prints a line for each patch or link on
 * the standard output of rank 0, behind a line naming the columns. Only the column
 * `owner`, the rank with the patch or the link, depends on the number of ranks. False if
 * ended by a signal. */
bool dump_print(struct run *run);

#endif
