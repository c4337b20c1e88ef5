/* Sums in fixed point. Ranks agree on the largest term of each column, and so on a unit
 * in which no sum can overflow; then integers are added up (rad/flux.h says why). */
#include "rad/beyond/total.h"

#include "geom/alloc.h"
#include "geom/vec.h"
#include "rad/flux.h"

/* Raises most[k] to the largest magnitude in column k of these terms. */
static void raise_to_terms(const double *terms, int64_t count, int columns, double *most)
{
    for (int k = 0; k < columns; k++) {
        double largest = most[k];
        for (int64_t i = 0; i < count; i++)
            largest = real_max(largest, fabs(terms[columns * i + k]));
        most[k] = largest;
    }
}

/* Adds the terms of column k to sums[k]; of those that are no numbers, any number. */
static void add_terms(const double *terms, int64_t count, int columns,
                      const struct flux_unit *units, int64_t *sums)
{
    for (int k = 0; k < columns; k++) {
        uint64_t sum = (uint64_t)sums[k];
        for (int64_t i = 0; i < count; i++)
            sum += (uint64_t)flux_from_watts(units[k], terms[columns * i + k]);
        sums[k] = (int64_t)sum;
    }
}

void total_groups(const struct totals *totals, const double *terms, const int32_t *group,
                  int64_t count, int32_t groups, int columns, double *sums)
{
    int64_t all = (int64_t)groups * columns, run = groups > 1 ? 1 : count;
    int64_t *parts = alloc_array((size_t)all, sizeof *parts);
    struct flux_unit *units = alloc_array((size_t)all, sizeof *units);
    for (int64_t j = 0; j < all; j++)
        sums[j] = 0.0; /* the largest */
    for (int64_t i = 0; i < count; i += run) {
        int64_t at = groups > 1 ? columns * group[i] : 0;
        raise_to_terms(terms + columns * i, run, columns, sums + at);
    }
    if (totals->largest)
        totals->largest(totals->context, sums, all);
    for (int64_t j = 0; j < all; j++)
        units[j] = flux_unit_for((double)totals->terms * sums[j]);
    for (int64_t i = 0; i < count; i += run) {
        int64_t at = groups > 1 ? columns * group[i] : 0;
        add_terms(terms + columns * i, run, columns, units + at, parts + at);
    }
    totals_add(totals, parts, all);
    for (int64_t j = 0; j < all; j++)
        sums[j] = flux_to_watts(units[j], parts[j]);
    alloc_free(units);
    alloc_free(parts);
}

void total_up(const struct totals *totals, const double *terms, int64_t count,
              int columns, double *sums)
{
    total_groups(totals, terms, NULL, count, 1, columns, sums);
}
