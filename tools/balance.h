/* Whether the powers of a run can be true. */
#ifndef TOOLS_BALANCE_H
#define TOOLS_BALANCE_H

#include "tools/run.h"

/* True, on all ranks alike, if far more light is absorbed than emitted: the answer is
 * worth nothing. Pre: compute_light() has succeeded. */
bool balance_is_absurd(const struct run *run);

/* On rank 0. The power emitted by lamps where they lie face to face with another surface,
 * unseen by others, W; counted as escaped in the sums of powers. */
double balance_touching(const struct run *run);

/* On rank 0. Warns if more light is absorbed than emitted, or arrives than leaves, or is
 * lost in a closed scene, or if lamps lie on each other; if absurdly more, sets
 * run->error (EXIT_FAILED). Pre: run->stats is filled, its escaped power without
 * balance_touching(). */
void balance_judge(struct run *run);

#endif
