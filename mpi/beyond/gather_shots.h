/* How many rays and segments each leaf of a final gather is worth. */
#ifndef MPI_BEYOND_GATHER_SHOTS_H
#define MPI_BEYOND_GATHER_SHOTS_H

#include <stdint.h>

/* Shares shots in proportion to `worth`, [count], at least 0, in any unit: `shots`,
 * [count], at least 4 each. Their sum is `mean` times `count` at most, unless these 4 are
 * too many. All are `mean` if nothing is worth anything. */
void gather_share_shots(const double *worth, int64_t count, int mean, int *shots);

#endif
