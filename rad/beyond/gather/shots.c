/* How many shots each leaf gets: rays in all directions, and segments to lamps.
 *
 * The noise of all is least if shots go in proportion to the deviation of a single one
 * (Neyman, 1934). Numbers of shots are the mean times powers of two, since points of a
 * sequence are spread best over these; numbers are within bounds, since deviations are
 * guesses. */
#include "rad/beyond/gather/shots.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "geom/alloc.h"

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

/* What a group shares. */
struct sharing {
    double *worth; /* [count] of its leaves that get more than the fewest, rising */
    int64_t count;
    double mean;   /* worth of a leaf that gets the mean number of shots */
};

/* Rising; equal ones are alike. */
static int compare_worths(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Returns the shots of all if those of a leaf of worth `middle` are the mean number. The
 * power of two rises with the worth. */
static int64_t shots_of_all(const struct sharing *share, double middle, int mean)
{
    int64_t shots = 0, first = 0;
    for (int power = -MOST_HALVED; power <= MOST_DOUBLED; power++) {
        int64_t low = first, high = share->count;
        while (low < high) {
            int64_t at = low + (high - low) / 2;
            if (power_of(share->worth[at] / middle) <= power)
                low = at + 1;
            else
                high = at;
        }
        shots += (low - first) * shots_of_power(power, mean);
        first = low;
    }
    return shots;
}

/* Finds the least mean with no more shots than the mean number for each. */
static void find_mean(struct sharing *share, int mean)
{
    qsort(share->worth, (size_t)share->count, sizeof *share->worth, compare_worths);
    double low = 0.0, high = share->count > 0 ? share->worth[share->count - 1] : 0.0;
    for (int step = 0; step < STEPS && high > 0.0; step++) {
        double middle = 0.5 * (low + high);
        bool more = shots_of_all(share, middle, mean) > share->count * mean;
        *(more ? &low : &high) = middle;
    }
    share->mean = high;
}

void shots_share(const double *worth, const int32_t *group, int64_t count, int32_t groups,
                 int mean, int *shots)
{
    struct sharing *shares = alloc_array((size_t)groups, sizeof *shares);
    double *sorted = alloc_array((size_t)count, sizeof *sorted);
    for (int64_t k = 0; k < count; k++)
        shares[group[k]].count += !(worth[k] < 0.0);
    double *next = sorted;
    for (int32_t g = 0; g < groups; g++) {
        shares[g].worth = next;
        next += shares[g].count;
        shares[g].count = 0;
    }
    for (int64_t k = 0; k < count; k++) {
        struct sharing *share = &shares[group[k]];
        if (!(worth[k] < 0.0)) /* the others get the fewest */
            share->worth[share->count++] = worth[k];
    }
    for (int32_t g = 0; g < groups; g++)
        find_mean(&shares[g], mean);
    for (int64_t k = 0; k < count; k++) {
        double own = shares[group[k]].mean;
        shots[k] = shots_of(own > 0.0 ? worth[k] / own : 2.0 * worth[k] + 1.0, mean);
    }
    alloc_free(sorted);
    alloc_free(shares);
}

int shots_of_black(int mean, double part)
{
    int rays = (int)(fmin(1.0, part) * mean);
    return rays > FEWEST ? rays : FEWEST;
}
