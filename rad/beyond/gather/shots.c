/* How many shots each leaf gets: rays in all directions, and segments to lamps.
 *
 * The noise of all is least if shots go in proportion to the deviation of a single one
 * (Neyman, 1934). Numbers of shots are the mean times powers of two, since points of a
 * sequence are spread best over these; numbers are within bounds, since deviations are
 * guesses. */
#include "rad/beyond/gather/shots.h"

#include <math.h>
#include <stdbool.h>

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

/* What a group shares: the worth of the mean number of shots is between two bounds. */
struct sharing {
    double low, high;
    int64_t shots; /* of all, if the middle is worth the mean */
    int64_t most;  /* that they may be */
};

static double middle_of(const struct sharing *share)
{
    return 0.5 * (share->low + share->high);
}

void shots_share(const double *worth, const int32_t *group, int64_t count, int32_t groups,
                 int mean, int *shots)
{
    struct sharing *shares = alloc_array((size_t)groups, sizeof *shares);
    for (int64_t k = 0; k < count; k++) {
        struct sharing *share = &shares[group[k]];
        if (worth[k] < 0.0) /* the fewest, beside the others */
            continue;
        share->high = fmax(share->high, worth[k]);
        share->most += mean;
    }
    for (int step = 0; step < STEPS; step++) {
        for (int64_t k = 0; k < count; k++) {
            struct sharing *share = &shares[group[k]];
            if (!(worth[k] < 0.0) && share->high > 0.0)
                share->shots += shots_of(worth[k] / middle_of(share), mean);
        }
        for (int32_t g = 0; g < groups; g++) {
            bool more = shares[g].shots > shares[g].most;
            *(more ? &shares[g].low : &shares[g].high) = middle_of(&shares[g]);
            shares[g].shots = 0;
        }
    }
    for (int64_t k = 0; k < count; k++) {
        double high = shares[group[k]].high;
        shots[k] = shots_of(high > 0.0 ? worth[k] / high : 2.0 * worth[k] + 1.0, mean);
    }
    alloc_free(shares);
}

int shots_of_black(int mean, double part)
{
    int rays = (int)(fmin(1.0, part) * mean);
    return rays > FEWEST ? rays : FEWEST;
}
