/* Exercises of chapter 8. */
#include <math.h>
#include <stdint.h>

/* Watts in integer units of 2^-bits W, rounded to the nearest. */
int64_t to_units(double watts, int bits)
{
    return (int64_t)watts;
}

/* home[i] becomes the rank, 0 to ranks - 1, that owns root i of this area, m^2: no rank
 * may have more area than another by more than the largest root. */
void deal_roots(const double *areas, int roots, int ranks, int *home)
{
    for (int i = 0; i < roots; i++)
        home[i] = i * ranks / roots;
}
