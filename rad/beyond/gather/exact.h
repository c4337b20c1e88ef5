/* Exact rows, where nothing is in the way. */
#ifndef RAD_BEYOND_GATHER_EXACT_H
#define RAD_BEYOND_GATHER_EXACT_H

#include "rad/beyond/gather/receiver.h"

/* True if proofs show that nothing stands between a root and the roots that it faces:
 * then its leaves may have exact rows. Without `proof`: if no segment finds a blocker. */
bool final_gather_root_is_open(struct final_gather *gather, int32_t root, bool proof);

/* Makes the row of a leaf from exact factors. False if its root is not open, or the row
 * cannot be exact; then rays are to make the row. */
bool receiver_add_exact(struct receiver *r);

#endif
