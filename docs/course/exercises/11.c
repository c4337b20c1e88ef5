/* Exercises of chapter 11. */
#include <math.h>

/* The number of rays by chance for this relative error of H, one deviation, where a lamp
 * of the form factor `factor` is all light. */
double rays_for(double factor, double error)
{
    return 1.0;
}

/* Sets the share of each of `count` nodes that is taken for seen, if `found` of `asked`
 * segments were seen. */
void share_seen(int count, const int *found, int asked, double *seen)
{
    for (int k = 0; k < count; k++)
        seen[k] = (double)found[k] / asked;
}

/* The deviation of H, W/m^2, that is to be claimed for `count` nodes none of whose
 * `fired` segments were seen. `light`, W/m^2: with nothing in the way. */
double doubt_of(int count, const double *light, const double *seen, const int *fired)
{
    return 0.0;
}
