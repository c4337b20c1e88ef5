/* The claim: how wrong the light of each leaf may be. Variances are of H, (W/m^2)^2. */
#ifndef RAD_BEYOND_GATHER_CLAIM_H
#define RAD_BEYOND_GATHER_CLAIM_H

#include "rad/beyond/gather/balance.h"
#include "rad/stats.h"

/* The variance of each row by factors of lamps, and by B varying within leaves seen by
 * the row. B varies independently in different leaves, so their errors add up as
 * variances. Pre: e->radiosity is the solution, as for the next. */
void claim_by_mesh(const struct equation *e, struct rgb *variance);

/* Collective. Finds the variance of each row by rays and segments: the one by chance,
 * times the ratio of a sequence's variance to that. The ratio is estimated over the
 * leaves of a space with about as much light. */
void claim_by_rays(const struct equation *e, struct rgb *variance);

/* Collective. Finds the bound on the error of B of 95 % of leaves, `error`, W/m^2, by the
 * largest deviation of a band; and what is told of all errors. `remaining`: what the
 * solution may lack, in parts of B. */
void claim_errors(const struct light_balance *balance, double remaining,
                  const struct rgb *mesh, const struct rgb *rays, double *error,
                  struct gathered *told);

/* The deviation of which `error`, of a leaf, is the bound. */
double claim_deviation(double error);

#endif
