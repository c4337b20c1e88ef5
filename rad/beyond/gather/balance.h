/* The balance of light in closed spaces: as much arrives as leaves. */
#ifndef RAD_BEYOND_GATHER_BALANCE_H
#define RAD_BEYOND_GATHER_BALANCE_H

#include "rad/beyond/gather/equation.h"

/* Of the balance of a space. */
struct flows {
    struct rgb all;     /* light of light_balance.spread, W in square scene units */
    struct rgb spread;  /* missing light over this, 1 */
    struct rgb missing; /* part of the light last leaving that did not arrive */
    double unsure;      /* part of B that light may be off by in the end */
};

struct light_balance {
    struct equation *equation; /* borrowed */
    bool apart;          /* no row sees another space than its leaf's */
    bool any;            /* some space is closed */
    bool *closed;        /* [lit_count()] hardly any ray of a space escapes, or light */
    struct flows *flows; /* [lit_count()] of spaces, or the first of all together */
    struct rgb *spread;  /* [leaves] how missing light is spread, W/m^2 a ray */
    double *terms;       /* buffer: of sums, for each leaf */
    double *sums;        /* buffer: W in square scene units, for each balance */
};

/* Finds the closed spaces. A space seen from another has no balance of its own: then all
 * have one together or none has any. `crossed`: terms and segments from one space to
 * another. Pre: equation->fired and `crossed` are sums over all rows; leaves have
 * covers. */
struct light_balance balance_start(struct equation *equation, int64_t crossed);
void balance_free(struct light_balance *b);

/* The balance of which a leaf is part. */
struct flows *balance_of(const struct light_balance *b, int64_t leaf);

/* The largest part of light missing in any band of a space. */
double balance_missing(const struct light_balance *b);

/* Collective, like all below. Spreads missing light as the irradiances `h` over the
 * numbers of rays. */
void balance_spread(struct light_balance *b, const struct rgb *h);

/* Adds missing light to irradiances `h` for the radiosities `from`, so that as much
 * arrives as leaves in a closed space. `lamps`: as of equation_show(). */
void balance_close(struct light_balance *b, const struct rgb *from, bool lamps,
                   struct rgb *h);

/* Scales the irradiances of closed spaces so that all kept light is absorbed. Their
 * balance lacks values below 0, now 0, and the residual of the equation. */
void balance_absorb(struct light_balance *b, struct rgb *h);

/* Finds spaces that are closed though rays escape. In a thing that touches walls and has
 * no faces there rays are lost on backs, but no light gets there. So a space is closed if
 * rays lose next to no light, compared with what is absorbed: in a white room lost light
 * is missing at every reflection. Leaves with a thing across, whose rays are of both
 * sides, do not count. A space with a sky is open. Returns whether there are more. */
bool balance_find_more(struct light_balance *b, const struct rgb *radiosity);

/* Finds by which part the light of an open space may be off in the end. Rows lose or make
 * light at each reflection, besides what leaves the scene. This light is reflected as
 * often as light straight from lamps: little in a dark room, a hundredfold in a white
 * one. So the part is their ratio. `h`: irradiances; `again`: those of the `reflected`
 * light alone. */
void balance_find_unsure(struct light_balance *b, const struct rgb *h,
                         const struct rgb *reflected, const struct rgb *again);

#endif
