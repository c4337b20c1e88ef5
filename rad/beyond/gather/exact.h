/* Exact rows, where nothing is in the way. */
#ifndef RAD_BEYOND_GATHER_EXACT_H
#define RAD_BEYOND_GATHER_EXACT_H

#include "rad/beyond/gather/receiver.h"

/* Makes the row of a leaf from exact factors. False if its root is not open, or the row
 * cannot be exact; then rays are to make the row. */
bool receiver_add_exact(struct receiver *r);

#endif
