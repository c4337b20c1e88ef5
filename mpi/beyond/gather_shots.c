/* How many shots each leaf gets: rays in all directions, and segments to lamps.
 *
 * The noise of all is least if shots go in proportion to the deviation of a single one
 * (Neyman, 1934). Numbers of shots are the mean times powers of two, since points of a
 * sequence are spread best over these; numbers are within bounds, since deviations are
 * guesses. */
#include "mpi/beyond/gather_mesh.h"

#include <math.h>

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

static int shots_of(double worth, int mean)
{
    int power = power_of(worth);
    int shots = power > 0 ? mean << power : mean >> -power;
    return worth < 0.0 || shots < FEWEST ? FEWEST : shots;
}

void gather_share_shots(const double *worth, int64_t count, int mean, int *shots)
{
    double low = 0.0, high = 0.0;
    int64_t all = 0;
    for (int64_t k = 0; k < count; k++) {
        high = fmax(high, worth[k]);
        all += worth[k] < 0.0 ? FEWEST : mean;
    }
    for (int step = 0; step < STEPS && high > 0.0; step++) { /* worth of the mean */
        double unit = 0.5 * (low + high);
        int64_t sum = 0;
        for (int64_t k = 0; k < count; k++)
            sum += shots_of(worth[k] / unit, mean);
        *(sum > all ? &low : &high) = unit;
    }
    for (int64_t k = 0; k < count; k++)
        shots[k] = shots_of(high > 0.0 ? worth[k] / high : 2.0 * worth[k] + 1.0, mean);
}
