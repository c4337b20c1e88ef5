/* How far the radiosities of the leaves below a patch lie apart, summed over bands,
 * W/m^2. */
#ifndef RAD_BEYOND_RANGE_H
#define RAD_BEYOND_RANGE_H

#include "rad/patch.h"

/* Finds the extremes of all patches there are. */
void forest_bound(struct forest *forest);

/* The largest range of a child of a patch as of then, 0 of a leaf. */
double forest_range_within(const struct forest *forest, int32_t patch);

#endif
