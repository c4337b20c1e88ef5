/* Solutions to the exercises of chapter 8. */
#include <math.h>
#include <stdint.h>

/* Watts in integer units of 2^-bits W, rounded to the nearest. */
int64_t to_units(double watts, int bits)
{
    return (int64_t)llrint(ldexp(watts, bits));
}

/* home[i] becomes the rank, 0 to ranks - 1, that owns root i of this area, m^2: no rank
 * may have more area than another by more than the largest root. */
void deal_roots(const double *areas, int roots, int ranks, int *home)
{
    for (int i = 0; i < roots; i++) {
        double least = HUGE_VAL; /* area that a rank has so far */
        for (int rank = 0; rank < ranks; rank++) {
            double sum = 0.0;
            for (int j = 0; j < i; j++)
                sum += home[j] == rank ? areas[j] : 0.0;
            if (sum < least) {
                least = sum;
                home[i] = rank;
            }
        }
    }
}
