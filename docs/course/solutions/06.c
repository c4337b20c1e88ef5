/* Solutions to the exercises of chapter 6. */
#include <stdbool.h>

/* BF refinement: true if a link with the exchange area g, m^2, between patches of
 * radiosities b_p and b_q, W/m^2, is to be split, all lamps emitting `power` watts. */
bool is_to_be_split(double g, double b_p, double b_q, double epsilon, double power)
{
    return g * (b_p + b_q) > epsilon * power;
}

/* Refinement by form factor: true if either of F_pq and F_qp is above epsilon; a_p and
 * a_q are the areas, m^2. */
bool by_factor(double g, double a_p, double a_q, double epsilon)
{
    return g > epsilon * a_p || g > epsilon * a_q;
}

/* The number of links if first each of `roots` roots is linked with each other, and then
 * all links are split `levels` times. */
double links_at_last(int roots, int levels)
{
    double links = 0.5 * roots * (roots - 1.0);
    while (levels-- > 0)
        links *= 4.0;
    return links;
}
