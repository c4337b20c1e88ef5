/* The solution as pictures, meshes and tables. */
#ifndef TOOLS_RESULTS_H
#define TOOLS_RESULTS_H

#include "tools/run.h"

/* Collective. Renders and writes the outputs named by the options. False on an error, on
 * all ranks. From then on no radiosity is below 0. */
bool results_show(struct run *run);

#endif
