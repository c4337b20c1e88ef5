/* Reading the input of a run. */
#ifndef TOOLS_INPUT_H
#define TOOLS_INPUT_H

#include "tools/run.h"

/* On rank 0. Reads run->scene, prepared, and run->cameras as the options say, warns of
 * repairs, and probes the outputs. Errors (a wrong file, a scene without light, an output
 * that cannot be written, a --show that cannot be) are in run->error. */
void input_read(struct run *run);

#endif
