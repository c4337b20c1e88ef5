/* The solution as pictures and meshes. */
#ifndef TOOLS_RESULTS_H
#define TOOLS_RESULTS_H

#include "tools/run.h"

/* Collective. Renders and writes the outputs that the options name. False on an error, on
 * all ranks. From then on no radiosity is below 0. */
bool results_show(struct run *run);

#endif
