/* How many shots each leaf gets: rays in all directions, and segments to lamps. */
#ifndef RAD_BEYOND_GATHER_SHOTS_H
#define RAD_BEYOND_GATHER_SHOTS_H

#include "rad/model.h"

/* Shares shots in proportion to `worth`, [count], in any unit: `shots`, [count], at least
 * 4 each, and 4 where the worth is -1, none. The sum of the others is `mean` times their
 * number at most, unless these 4 are too many; all are `mean` if all are worth 0. */
void shots_share(const double *worth, int64_t count, int mean, int *shots);

/* The same among the leaves, [count], of each space apart: `worth` and `shots`,
 * [2 * count], of the rays and the segments of each leaf. */
void shots_share_by_space(const struct model *model, const int32_t *leaves, int64_t count,
                          const double *worth, int mean, int *shots);

/* Rays of a black leaf, for the balance of power alone, whose noise most comes from rows
 * of large leaves: this part of the mean number, at most all. */
int shots_of_black(int mean, double part);

#endif
