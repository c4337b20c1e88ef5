/* Sums over the leaves of all ranks, each of which has some: the same, to the last bit,
 * however the leaves are dealt. */
#ifndef RAD_BEYOND_TOTAL_H
#define RAD_BEYOND_TOTAL_H

#include <stdint.h>

/* How ranks agree on numbers: each becomes the largest, or the sum, of all ranks. */
struct totals {
    void (*largest)(void *context, double *numbers, int64_t count);
    void (*add)(void *context, int64_t *numbers, int64_t count);
    void *context;
    int64_t terms; /* of all ranks in a sum, at most */
};

/* Collective. sums[k] = sum over i of terms[columns i + k], over all ranks; i < count.
 * The error of a sum is at most 2^-62 times the square of totals->terms, times the
 * largest term. Pre: columns <= 2 BANDS. */
void total_up(const struct totals *totals, const double *terms, int64_t count,
              int columns, double *sums);

#endif
