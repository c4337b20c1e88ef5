/* Exercises of chapter 4. */
#include <math.h>
#include <stdbool.h>

/* True if the triangle t stands between the points x and y. (Points and corners are
 * arrays of three coordinates.) */
bool is_blocked(double t[3][3], const double x[3], const double y[3])
{
    return false;
}

/* True if no point of the segment from x to y is in the box from `low` to `high`. */
bool misses_box(const double x[3], const double y[3], const double low[3],
                const double high[3])
{
    return false;
}
