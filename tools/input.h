/* Reading what a run needs. */
#ifndef TOOLS_INPUT_H
#define TOOLS_INPUT_H

#include "tools/run.h"

/* On rank 0: run->scene, prepared, and run->camera, as the options say; warns of repairs.
 * Errors (a wrong file, nothing that emits, an output that can't be written) are in
 * run->error. */
void input_read(struct run *run);

#endif
