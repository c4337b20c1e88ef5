/* Conjugate gradients for the irradiances of the leaves of a rank's own roots.
 *
 * The equation is K H = F' E with K = 1 - F' rho: H is irradiance, W/m^2, and F' the form
 * factors with their caps. Vectors have three bands per patch; only those of own leaves
 * mean anything. Every function works on own leaves alone; sums over all ranks are
 * returned as this rank's part of them, in integers. */
#ifndef RAD_BEYOND_CONJUGATE_H
#define RAD_BEYOND_CONJUGATE_H

#include <stdbool.h>
#include <stdint.h>

#include "rad/beyond/caps.h"
#include "rad/model.h"

struct conjugate {
    struct rgb *irradiance; /* H, W/m^2; [count], like the others by local patch number */
    struct rgb *residual;   /* z = F' B - H, with B = E + rho H */
    struct rgb *work;       /* K z */
    struct rgb *direction;  /* p */
    struct rgb *image;      /* K p */
    struct rgb *sent;       /* rho z of all ranks, and its means over inner patches */
    int64_t count, capacity[6];
    int32_t *leaves;        /* [leaf_count] the own leaves, by local patch number */
    int64_t leaf_count, leaf_capacity;
};

/* Sums over one rank's leaves and over bands, in units of model.flux_unit unless said. */
struct conjugate_sums {
    int64_t square[BANDS]; /* <z, z>, band by band, in the unit given */
    int64_t light;         /* A B */
    int64_t absorbed;      /* A (1 - rho) H */
    int64_t arriving;      /* A (H + z) */
    int64_t bulk;          /* the largest magnitude of these three, leaf by leaf: while it
                              is below FLUX_LIMIT, none of them has met that limit */
    int64_t negative;      /* A rho |H| where H < 0 */
    int64_t missing;       /* A / d |z| */
    double largest;        /* largest |z|, W/m^2 */
};

void conjugate_free(struct conjugate *cg);

/* Makes room for all patches and lists the own leaves; new patches inherit H from their
 * parents. To be called after patches have been split. */
void conjugate_extend(struct conjugate *cg, const struct forest *forest, const bool *own);

/* The unit for scalar products of vectors that are nowhere larger than a and b.
 * `weight`: the largest 1 / d. */
struct flux_unit conjugate_unit(const struct model *model, double a, double b,
                                double weight);

/* After a transfer of B: z = F' B - H. Where nothing is reflected, H = F' B and z = 0. */
void conjugate_start(struct conjugate *cg, const struct model *model,
                     const struct caps *caps, struct flux_unit flux);

/* After a transfer of rho z: work = K z. Adds <work, z> to `product`. */
void conjugate_apply(struct conjugate *cg, const struct model *model,
                     const struct caps *caps, struct flux_unit flux,
                     struct flux_unit unit, int64_t product[BANDS]);

/* p = z + turn p, K p = work + turn K p, H += step p, z -= step K p. */
void conjugate_advance(struct conjugate *cg, const struct model *model,
                       const double turn[BANDS], const double step[BANDS]);

/* Puts rho z of the own leaves into `sent`; and their B into the radiosities. */
void conjugate_send(struct conjugate *cg, const struct model *model);
void conjugate_finish(const struct conjugate *cg, struct model *model);

struct conjugate_sums conjugate_sum(const struct conjugate *cg, const struct model *model,
                                    const struct caps *caps, struct flux_unit unit);

#endif
