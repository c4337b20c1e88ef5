/* The claim: how wrong the light of each leaf may be. Variances are of H, (W/m^2)^2. */
#ifndef RAD_BEYOND_GATHER_CLAIM_H
#define RAD_BEYOND_GATHER_CLAIM_H

#include "rad/beyond/gather/balance.h"
#include "rad/stats.h"

/* The variance of each row by factors of lamps, and by B varying within leaves seen by
 * the row. B varies independently in different leaves, so their errors add up as
 * variances. Pre: e->radiosity is the solution, as for the next. */
void claim_by_mesh(const struct equation *e, struct rgb *variance);

/* Finds two variances of each row, as by chance: that by rays, and that by segments. Rows
 * were made with the light of the links, which may have brought much through a window, or
 * none. So the one by rays is scaled as the variance of B over its terms changes, as if
 * each ray brought the light of one. Pre: the forest has the light of the links. */
void claim_find_noise(const struct equation *e, struct rgb *by_rays,
                      struct rgb *by_segments);

/* Raises the variance of leaves, [count], to the mean over their sisters, each by one
 * ray. The rays of a leaf may have missed a small bright thing that a sister has found:
 * then its light is too dark, and its own variance too small. `rays`: of each leaf; or
 * segments. */
void claim_raise_to_sisters(const struct forest *forest, const int32_t *leaves,
                            int64_t count, const int *rays, struct rgb *variance);

/* Collective. Makes variances by chance those of a sequence. The ratio of the two is
 * estimated over the leaves of a space with about as much light. */
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
