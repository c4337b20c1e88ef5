/* Options that do nothing. */
#ifndef TOOLS_IDLE_H
#define TOOLS_IDLE_H

#include "tools/run.h"

/* Warns once of the options given without effect on the outputs asked for; and of options
 * overruled by --paper behind them. */
void idle_warn(struct run *run);

/* Warns once of the options given for computing light, as the scene turns out to be a
 * stored solution. */
void idle_warn_stored(struct run *run);

#endif
