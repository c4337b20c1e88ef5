/* The exchange area of two nodes, one of which at least is a cluster. */
#ifndef RAD_BEYOND_NODE_EXCHANGE_H
#define RAD_BEYOND_NODE_EXCHANGE_H

#include "rad/beyond/node.h"

/* An estimate. G of a cluster with itself is of both directions. */
struct node_exchange {
    double g_p[4];     /* G of each child of p, visibility included; sum: area */
    double g_q[4];     /* the same of q */
    double unoccluded; /* G without blockers, at most the smaller area */
    double area;       /* G with blockers */
};

/* True if the two are sampled by rays and not by points. */
bool is_by_rays(const struct meeting *m);

/* Another `salt`, other points. */
struct node_exchange node_exchange_estimate(struct model *model,
                                            const struct meeting *m, int salt);

#endif
