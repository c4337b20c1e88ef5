/* B over a patch, linear where the patch has sisters. */
#ifndef RAD_BEYOND_GATHER_SLOPE_H
#define RAD_BEYOND_GATHER_SLOPE_H

#include "rad/model.h"

struct gather_slope {
    int32_t first; /* child 0 of the patch, or of its parent */
    double rise;   /* s, made less where B would be below 0; 0: B is constant */
    double range;  /* largest difference of B from its value at the centre, over all
                      bands; in exact rows of one band, scaled, W/m^2 */
};

/* Returns the slope of B over a leaf, or over an inner patch as a whole: 0 over an
 * undivided root, and where the parent is cut (`cut`: see struct final_gather). `scale`:
 * factors of bands in exact rows; else NULL. */
struct gather_slope slope_of(const struct forest *forest, const uint8_t *cut,
                             int32_t patch, const struct rgb *scale);

/* Returns B of a patch by the linear function over its parent, W/m^2. Pre: the patch has
 * a parent. */
struct rgb light_by_parent(const struct forest *forest, int32_t patch);

/* Returns how many levels deep a leaf with an exact row is to be split: 0 if in no band B
 * bends more over the leaf than allowed, else 1, or more if bends over its children are
 * too large. `all`: the sum of area times the square of reflected radiosity over all
 * leaves. */
int slope_splits(const struct model *model, int32_t leaf, const struct rgb *all);

#endif
