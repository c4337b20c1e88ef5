/* How many rays and segments each leaf of a final gather is worth. */
#ifndef MPI_BEYOND_GATHER_SHOTS_H
#define MPI_BEYOND_GATHER_SHOTS_H

#include <stdint.h>

/* Shares shots in proportion to `worth`, [count], in any unit: `shots`, [count], at least
 * 4 each, and 4 where the worth is -1, none. The sum of the others is `mean` times their
 * number at most, unless these 4 are too many; all are `mean` if all are worth 0. */
void gather_share_shots(const double *worth, int64_t count, int mean, int *shots);

#endif
