/* What travels in every transfer of light over the same links: which proxies receive flux and go home,
 * and whose radiosities come back. Found out once, so that the transfers need no IDs, no counts and no
 * searching. */
#ifndef MPI_ROUTES_H
#define MPI_ROUTES_H

#include <stdint.h>

struct solver;

/* Lists of local patch numbers. */
struct routes {
    int32_t *out;     /* [sum of out_counts] proxies that links here give light to, home by home */
    int32_t *in;      /* [sum of in_counts] own patches that these are on other ranks, rank by rank */
    int32_t *leaves;  /* [sum of leaf_counts] leaves whose B can change, rank by rank; of each home
                         roots in order, depth first: the same on all ranks */
    int *out_counts, *in_counts, *leaf_counts; /* [ranks] */
};

/* Collective. Renews the routes of the solver. Pre: all ranks have the same trees. */
void routes_renew(struct solver *solver);
void routes_free(struct routes *routes);

#endif
