/* Sums over the leaves of all ranks, each of which has some: the same, to the last bit,
 * however the leaves are dealt. */
#ifndef RAD_BEYOND_TOTAL_H
#define RAD_BEYOND_TOTAL_H

#include <stdint.h>

/* How ranks agree on numbers: each becomes the largest, or the sum, of all ranks. NULL:
 * there is one rank. */
struct totals {
    void (*largest)(void *context, double *numbers, int64_t count);
    void (*add)(void *context, int64_t *numbers, int64_t count);
    void *context;
    int64_t terms; /* of all ranks in a sum, at most */
};

/* Collective. Adds up integers of all ranks. */
static inline void totals_add(const struct totals *totals, int64_t *numbers,
                              int64_t count)
{
    if (totals->add)
        totals->add(totals->context, numbers, count);
}

/* Collective. sums[columns g + k] = sum of terms[columns i + k] over the i with
 * group[i] = g, over all ranks; i < count. With one group `group` may be NULL. The error
 * of a sum is at most 2^-62 times the square of totals->terms, times its largest term. */
void total_groups(const struct totals *totals, const double *terms, const int32_t *group,
                  int64_t count, int32_t groups, int columns, double *sums);

/* Collective. The same without groups. */
void total_up(const struct totals *totals, const double *terms, int64_t count,
              int columns, double *sums);

#endif
