/* Exercises of chapter 10. */
#include <math.h>

/* A bound on the change that is still to come, if the last bounce changed a radiosity by
 * `change`, and each leaves the part q of the error. */
double still_missing(double change, double q)
{
    return change;
}

/* The root of the mean square of the relative errors of `count` values. */
double relative_rms(int count, const double *values, const double *answers)
{
    return 0.0;
}

/* The number of bounces after which that bound is at most `tolerance`, if the first
 * bounce changes B by 1, and each changes it by q times what the one before did. */
int bounces_for(double q, double tolerance)
{
    return 0;
}
