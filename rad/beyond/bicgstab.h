/* Systems of unsymmetric linear equations, for the three bands side by side. Each rank
 * has some of the unknowns. */
#ifndef RAD_BEYOND_BICGSTAB_H
#define RAD_BEYOND_BICGSTAB_H

#include <stdint.h>

#include "geom/vec.h"
#include "rad/beyond/total.h"

/* Collective. y = A x, vectors as below. */
typedef void linear_map(void *context, const struct rgb *x, struct rgb *y);

struct bicgstab {
    int steps;       /* done; each takes two products with A */
    double residual; /* sum of weight |b - A x| over that of weight |x|, bands together */
};

/* When to stop: at the first of these. */
struct bicgstab_end {
    double residual; /* at most, 1 */
    double part;     /* of the first residual, at most, 1 */
    int steps;
};

/* Collective. Improves x. `r`: its residual b - A x, before and after. Vectors are
 * [count], of this rank; `weights`, [count], above 0, are those of their scalar
 * product. */
struct bicgstab bicgstab_solve(linear_map *map, void *context,
                               const struct totals *totals, const double *weights,
                               int64_t count, struct bicgstab_end end, struct rgb *x,
                               struct rgb *r);

#endif
