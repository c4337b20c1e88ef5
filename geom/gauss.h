/* Gauss-Legendre quadrature: n points, exact for polynomials of degree 2 n - 1. */
#ifndef GEOM_GAUSS_H
#define GEOM_GAUSS_H

/* One point and its mirror image in the interval [-1, 1]. */
struct gauss_pair {
    double at;     /* above 0 */
    double weight; /* of each of the two; the weights of a rule have the sum 2 */
};

struct gauss {
    int pairs; /* half of the number of points */
    const struct gauss_pair *pair;
};

/* Returns the smallest rule of at least `points` points, out of 4, 6, 10 and 16. */
struct gauss gauss_rule(int points);

/* Returns point k = 0 .. 2 pairs - 1 of a rule in the interval [0, 1], and its weight
 * there; the weights have the sum 1. */
double gauss_point(const struct gauss *rule, int k, double *weight);

#endif
