/* Whether the powers of a run can be true. */
#ifndef TOOLS_BALANCE_H
#define TOOLS_BALANCE_H

#include "tools/run.h"

/* True, on all ranks alike, if so much more light is absorbed than emitted that the
 * answer is worth nothing. Pre: compute_light() has succeeded. */
bool balance_is_absurd(const struct run *run);

/* On rank 0. The power that lamps emit where they lie face to face with another surface
 * and nothing else sees them, W; the sums of powers count it as escaped. */
double balance_touching(const struct run *run);

/* On rank 0. Warns if more light is absorbed than emitted, or arrives than leaves, or is
 * lost in a closed scene, or if lamps lie on each other; if it is absurd, sets run->error
 * (EXIT_FAILED). Pre: run->stats is filled,
 * and what escapes is without balance_touching(). */
void balance_judge(struct run *run);

#endif
