/* --form-factors. */
#ifndef TOOLS_FACTORS_H
#define TOOLS_FACTORS_H

#include "tools/run.h"

/* Collective, on a run that has a scene: prints the form factors between its groups. Errors
 * are in run->error, on all ranks. */
void factors_tabulate(struct run *run);

#endif
