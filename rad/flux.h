/* Light as integers: flux in fixed point.
 *
 * Flux [W, areas in square scene units] is summed as integers, llrint(x * 2^k). Integer
 * sums do not depend on their order, so no result depends on which rank held which link.
 * Each transfer has its own k, chosen so that no flux can overflow (rad/link.h); k of a
 * run, for powers added by ranks, is chosen once. flux_add() stops at FLUX_LIMIT; a sum
 * of non-negative numbers stopping at a limit is the same in any order too, so "it
 * diverged" is seen by all ranks alike.
 *
 * Rejected: sums in double (their last bits depend on the order, and one bit is enough to
 * split a patch on 3 ranks that is whole on 2), and reproducible floating-point sums (six
 * words an accumulator where one integer does). */
#ifndef RAD_FLUX_H
#define RAD_FLUX_H

#include <math.h>
#include <stdint.h>

#include "geom/scene.h"

/* A sum reaching this has diverged. */
#define FLUX_LIMIT (INT64_C(1) << 62)

struct flux_unit {
    double per_watt; /* 2^k, integer units in a watt */
    double watt;     /* 2^-k, watts in an integer unit */
};

/* The unit in which sums up to `largest` watts stay below FLUX_LIMIT: a power of two.
 * Below 2^-960 it is the unit of 2^-960. Pre: 0 <= largest. */
static inline struct flux_unit flux_unit_for(double largest)
{
    int exponent;
    frexp(largest, &exponent); /* largest < 2^exponent */
    if (exponent < -960)
        exponent = -960; /* 2^(62 + 960) is finite, its inverse exact */
    return (struct flux_unit){ldexp(1.0, 62 - exponent), ldexp(1.0, exponent - 62)};
}

/* Watts in integer units, between -FLUX_LIMIT and FLUX_LIMIT, which NaN counts as. */
static inline int64_t flux_from_watts(struct flux_unit unit, double watts)
{
    double scaled = watts * unit.per_watt;
    if (!(fabs(scaled) < (double)FLUX_LIMIT))
        return scaled < 0.0 ? -FLUX_LIMIT : FLUX_LIMIT;
    return (int64_t)llrint(scaled);
}

static inline double flux_to_watts(struct flux_unit unit, int64_t flux)
{
    return (double)flux * unit.watt;
}

/* a + b, between -FLUX_LIMIT and FLUX_LIMIT. Pre: so are a and b. */
static inline int64_t flux_add(int64_t a, int64_t b)
{
    if (b > 0)
        return a < FLUX_LIMIT - b ? a + b : FLUX_LIMIT; /* a + b itself might overflow */
    return a > -FLUX_LIMIT - b ? a + b : -FLUX_LIMIT;
}

#endif
