/* --dump: all patches, or all links, as text. */
#ifndef TOOLS_DUMP_H
#define TOOLS_DUMP_H

#include "tools/run.h"

/* Collective, after compute_light(). With --dump, prints a line for each patch or link on
 * the standard output of rank 0, behind a line that names the columns. Only the column
 * `owner`, the rank that has the patch or the link, depends on the number of ranks. False
 * if a signal has ended it. */
bool dump_print(struct run *run);

#endif
