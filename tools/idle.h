/* Options that do nothing. */
#ifndef TOOLS_IDLE_H
#define TOOLS_IDLE_H

#include "tools/run.h"

/* Warns once of the options given that do nothing for the outputs asked for; and of those
 * that --paper behind them overrules. */
void idle_warn(struct run *run);

/* Warns once of the options given that say how light is computed, as the scene turns out
 * to be a stored solution. */
void idle_warn_stored(struct run *run);

#endif
