/* The claim: how wrong the light of each leaf may be. Variances are of H, (W/m^2)^2. */
#ifndef RAD_BEYOND_GATHER_CLAIM_H
#define RAD_BEYOND_GATHER_CLAIM_H

#include "rad/beyond/gather/balance.h"
#include "rad/stats.h"

/* The variance of each row by factors of lamps, and by B varying within leaves seen by
 * the row. B varies independently in different leaves, so their errors add up as
 * variances. Pre: e->radiosity is the solution, as for the next. */
void claim_by_mesh(const struct equation *e, struct rgb *variance);

/* How much the variance of each row by rays changes as the light of the links gives way
 * to the solution, 1: links may have brought much light through a window, or none. As if
 * each ray brought the light of a term: all rays weigh the same. Pre: the forest has the
 * light of the links. */
void claim_find_changes(const struct equation *e, struct rgb *change);

/* Makes `variance`, by chance, the one by the choice of rays: as it changes, times the
 * sequence's ratio, estimated over all leaves with about as much light. All are by leaf,
 * [count]: `halves`, and of `variance` the part by `segments`, from the rows. */
void claim_by_rays(const struct equation *e, const struct rgb *halves,
                   const struct rgb *change, struct rgb *segments, struct rgb *variance);

/* Sets the bound on the error of B of 95 % of leaves, `error`, [patches], W/m^2, by the
 * largest deviation of a band; and what is told of all errors. `remaining`: what the
 * solution may lack, in parts of B. */
void claim_errors(const struct light_balance *balance, double remaining,
                  const struct rgb *mesh, const struct rgb *rays, float *error,
                  struct gathered *told);

/* The deviation of which `error`, of a leaf, is the bound. */
double claim_deviation(double error);

#endif
