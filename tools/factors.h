/* --form-factors. */
#ifndef TOOLS_FACTORS_H
#define TOOLS_FACTORS_H

#include "tools/run.h"

/* Collective. Prints the form factors between the groups of the scene. Pre: run->scene
 * and run->octree are there. Errors are in run->error, on all ranks. */
void factors_tabulate(struct run *run);

#endif
