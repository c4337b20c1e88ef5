/* Where leaves with exact rows are too large for B to be linear over them. */
#ifndef RAD_BEYOND_GATHER_BENDS_H
#define RAD_BEYOND_GATHER_BENDS_H

#include "rad/model.h"

/* Returns how many times a leaf is to be split: 0, or once if in any band B bends more
 * over the leaf than allowed, or more often if a level is not enough for the bend. `all`:
 * the sum of area times the square of reflected radiosity over all leaves. */
int gather_splits_of(const struct model *model, int32_t leaf, const struct rgb *all);

#endif
