/* Solutions to the exercises of chapter 10. */
#include <math.h>

/* A bound on the change that is still to come, if the last bounce changed a radiosity by
 * `change`, and each leaves the part q of the error. */
double still_missing(double change, double q)
{
    return change * q / (1.0 - q);
}

/* The root of the mean square of the relative errors of `count` values. */
double relative_rms(int count, const double *values, const double *answers)
{
    double squares = 0.0;
    for (int i = 0; i < count; i++) {
        double error = values[i] / answers[i] - 1.0;
        squares += error * error;
    }
    return sqrt(squares / count);
}

/* The number of bounces after which that bound is at most `tolerance`, if the first
 * bounce changes B by 1, and each changes it by q times what the one before did. */
int bounces_for(double q, double tolerance)
{
    int bounces = 1;
    for (double change = 1.0; change * q / (1.0 - q) > tolerance; change *= q)
        bounces++;
    return bounces;
}
