/* How many shots each leaf gets: rays in all directions, and segments to lamps. */
#ifndef RAD_BEYOND_GATHER_SHOTS_H
#define RAD_BEYOND_GATHER_SHOTS_H

#include "rad/model.h"

/* Shares shots in proportion to `worth`, [count], in any unit: `shots`, [count], at least
 * 4 each, and 4 where the worth is -1, none. The others get `mean` on average at most,
 * unless 4 are more. If all are worth 0 each gets `mean`. */
void shots_share(const double *worth, int64_t count, int mean, int *shots);

/* The same among the leaves, [count], of each space apart: `worth` and `shots`,
 * [2 * count], of the rays and the segments of each leaf. */
void shots_share_by_space(const struct model *model, const int32_t *leaves, int64_t count,
                          const double *worth, int mean, int *shots);

/* Returns the rays of a black leaf: this part of the mean number, at most all. They serve
 * the balance of power alone, most of whose noise is that of large leaves. */
int shots_of_black(int mean, double part);

#endif
