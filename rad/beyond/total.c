/* Sums in fixed point. Ranks agree on the largest term of each column, and so on a unit
 * in which no sum can overflow; then integers are added up (rad/flux.h says why). */
#include "rad/beyond/total.h"

#include "geom/vec.h"
#include "rad/flux.h"

void total_up(const struct totals *totals, const double *terms, int64_t count,
              int columns, double *sums)
{
    double most[2 * BANDS] = {0.0};
    uint64_t sums_of[2 * BANDS] = {0}; /* of terms that are no numbers, any number */
    int64_t parts[2 * BANDS];
    struct flux_unit units[2 * BANDS];
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < columns; k++)
            most[k] = real_max(most[k], fabs(terms[columns * i + k]));
    totals->largest(totals->context, most, columns);
    for (int k = 0; k < columns; k++)
        units[k] = flux_unit_for((double)totals->terms * most[k]);
    for (int64_t i = 0; i < count; i++)
        for (int k = 0; k < columns; k++)
            sums_of[k] += (uint64_t)flux_from_watts(units[k], terms[columns * i + k]);
    for (int k = 0; k < columns; k++)
        parts[k] = (int64_t)sums_of[k];
    totals->add(totals->context, parts, columns);
    for (int k = 0; k < columns; k++)
        sums[k] = flux_to_watts(units[k], parts[k]);
}
