/* How many shots each leaf gets: rays in all directions, and segments to lamps. */
#ifndef RAD_BEYOND_GATHER_SHOTS_H
#define RAD_BEYOND_GATHER_SHOTS_H

#include <stdint.h>

/* Shares shots in proportion to `worth`, [count], in any unit, in each group apart:
 * `shots`, [count], at least 4 each, and 4 where the worth is -1, none. The others get
 * `mean` on average at most, unless 4 are more. If all are worth 0 each gets `mean`.
 * `group`: [count] 0 .. groups - 1. */
void shots_share(const double *worth, const int32_t *group, int64_t count, int32_t groups,
                 int mean, int *shots);

/* Returns the rays of a black leaf: this part of the mean number, at most all. They serve
 * the balance of power alone, most of whose noise is that of large leaves. */
int shots_of_black(int mean, double part);

#endif
