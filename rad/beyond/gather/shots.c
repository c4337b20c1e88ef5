/* How many shots each leaf gets: rays in all directions, and segments to lamps.
 *
 * The noise of all is least if shots go in proportion to the deviation of a single one
 * (Neyman, 1934). Numbers of shots are the mean times powers of two, since points of a
 * sequence are spread best over these; numbers are within bounds, since deviations are
 * guesses. */
#include "rad/beyond/gather/shots.h"

#include <math.h>
#include <stdlib.h>

#include "geom/alloc.h"
#include "rad/beyond/gather/lit.h"

/* A leaf gets 2^MOST_DOUBLED times the mean number at most, and 2^-MOST_HALVED at
 * least. */
enum { MOST_DOUBLED = 4, MOST_HALVED = 2, FEWEST = 4, STEPS = 40 };

/* The power of two next to a leaf's worth over the mean's, within bounds. */
static int power_of(double worth)
{
    int power = 0;
    for (; worth >= 1.4142135623730951 && power < MOST_DOUBLED; worth *= 0.5)
        power++;
    for (; worth < 0.7071067811865476 && power > -MOST_HALVED; worth *= 2.0)
        power--;
    return power;
}

static int shots_of_power(int power, int mean)
{
    int shots = power > 0 ? mean << power : mean >> -power;
    return shots < FEWEST ? FEWEST : shots;
}

static int shots_of(double worth, int mean)
{
    return worth < 0.0 ? FEWEST : shots_of_power(power_of(worth), mean);
}

/* A compare function of qsort(); equal numbers are alike. */
static int compare_worths(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* The number of leaves with less than this power, of sorted worths. */
static int64_t count_below(const double *sorted, int64_t count, double unit, int power)
{
    int64_t low = 0, high = count;
    while (low < high) {
        int64_t middle = (low + high) / 2;
        if (power_of(sorted[middle] / unit) < power)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The shots of all leaves with these sorted worths, if `unit` is worth the mean. */
static int64_t shots_of_all(const double *sorted, int64_t count, double unit, int mean)
{
    int64_t sum = 0, below = 0;
    for (int power = -MOST_HALVED; power <= MOST_DOUBLED; power++) {
        int64_t so_far = power < MOST_DOUBLED
                             ? count_below(sorted, count, unit, power + 1) : count;
        sum += (so_far - below) * shots_of_power(power, mean);
        below = so_far;
    }
    return sum;
}

void shots_share(const double *worth, int64_t count, int mean, int *shots)
{
    double low = 0.0, high = 0.0, *sorted = alloc_array((size_t)count, sizeof *sorted);
    int64_t sharing = 0; /* leaves; the others get the fewest */
    for (int64_t k = 0; k < count; k++)
        if (!(worth[k] < 0.0))
            sorted[sharing++] = worth[k];
    qsort(sorted, (size_t)sharing, sizeof *sorted, compare_worths);
    if (sharing > 0)
        high = fmax(0.0, sorted[sharing - 1]);
    for (int step = 0; step < STEPS && high > 0.0; step++) { /* worth of the mean */
        double unit = 0.5 * (low + high);
        bool more = shots_of_all(sorted, sharing, unit, mean) > sharing * mean;
        *(more ? &low : &high) = unit;
    }
    for (int64_t k = 0; k < count; k++)
        shots[k] = shots_of(high > 0.0 ? worth[k] / high : 2.0 * worth[k] + 1.0, mean);
    alloc_free(sorted);
}

void shots_share_by_space(const struct model *model, const int32_t *leaves, int64_t count,
                          const double *worth, int mean, int *shots)
{
    int32_t spaces = lit_count(model);
    int64_t *at = alloc_array((size_t)spaces + 1, sizeof *at);
    double *sorted = alloc_array(2 * (size_t)count, sizeof *sorted);
    int *dealt = alloc_array(2 * (size_t)count, sizeof *dealt);
    for (int64_t k = 0; k < 2 * count; k++)
        at[node_space(model, leaves[k / 2]) + 1]++;
    for (int32_t s = 0; s < spaces; s++)
        at[s + 1] += at[s];
    for (int64_t k = 0; k < 2 * count; k++)
        sorted[at[node_space(model, leaves[k / 2])]++] = worth[k];
    for (int32_t s = spaces; s > 0; s--) /* back to where each begins */
        at[s] = at[s - 1];
    at[0] = 0;
    for (int32_t s = 0; s < spaces; s++)
        shots_share(sorted + at[s], at[s + 1] - at[s], mean, dealt + at[s]);
    for (int64_t k = 0; k < 2 * count; k++)
        shots[k] = dealt[at[node_space(model, leaves[k / 2])]++];
    alloc_free(dealt);
    alloc_free(sorted);
    alloc_free(at);
}

int shots_of_black(int mean, double part)
{
    int rays = (int)(fmin(1.0, part) * mean);
    return rays > FEWEST ? rays : FEWEST;
}
