/* Reading the input of a run. */
#ifndef TOOLS_INPUT_H
#define TOOLS_INPUT_H

#include "tools/run.h"

/* Collective. Rank 0 reads run->scene, prepared, and run->cameras as the options say,
 * warns of repairs, and probes the outputs; all receive scene, octree and cameras. False
 * on an error (a wrong file, a scene without light, an output that cannot be written, an
 * impossible --show), which is in run->error, on all ranks. */
bool input_broadcast(struct run *run);

/* Says, once, which axis is up, and why. */
void input_say_up(struct run *run);

#endif
