/* What two nodes exchange, where one of them at least is a cluster. */
#ifndef RAD_BEYOND_NODE_EXCHANGE_H
#define RAD_BEYOND_NODE_EXCHANGE_H

#include "rad/beyond/node.h"

/* An estimate. G of a cluster with itself is that of both directions. */
struct node_exchange {
    double g_p[4], g_q[4]; /* what the children of p and of q exchange, with visibility,
                              G; sums: area */
    double unoccluded;     /* G without blockers, at most the smaller area */
    double area;           /* G with */
};

/* True if the two are sampled by rays and not by points. */
bool is_by_rays(const struct meeting *m);

/* Another `salt`, other points. `closely`: by all pairs of points, not by four of them.
 */
struct node_exchange node_exchange_estimate(struct method *method,
                                            const struct meeting *m, int salt,
                                            bool closely);

#endif
