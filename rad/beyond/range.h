/* How far the radiosities of the leaves below a patch lie apart, W/m^2. */
#ifndef RAD_BEYOND_RANGE_H
#define RAD_BEYOND_RANGE_H

#include "rad/patch.h"

/* Raises the range of each patch, [forest->count], to the range in a band, or of the sum
 * over bands if `band` is BANDS. `scale`: [roots] factor of the ranges of each. */
void forest_raise_ranges(const struct forest *forest, int band, const double *scale,
                         float *ranges);

/* Finds the largest ranges of children, summed over bands, of these trees, parents before
 * children. `patches`: [count]; NULL: all. */
void forest_bound(struct forest *forest, const int32_t *patches, int64_t count);

/* The largest range of a child of a patch as of then, 0 of a leaf. */
double forest_range_within(const struct forest *forest, int32_t patch);

#endif
