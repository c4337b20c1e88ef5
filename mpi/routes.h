/* What travels in every transfer of light over the same trees: flux to the homes of patches, and
 * radiosities back. Found out once, so that the transfers need no IDs, no counts and no searching. */
#ifndef MPI_ROUTES_H
#define MPI_ROUTES_H

#include <stdint.h>

#include "geom/scene.h"

struct solver;

/* Lists of local patch numbers, home by home; of each home roots in order, depth first: the same on all
 * ranks. */
struct routes {
    int32_t *receivers; /* [sum of receiver_counts] patches that can receive light */
    int32_t *leaves;    /* [sum of leaf_counts] leaves whose B can change */
    int *receiver_counts, *leaf_counts; /* [ranks] */
    int64_t *flux, *own_flux;   /* [3 * sum of receiver_counts], [3 * this rank's]: room for what travels */
    struct rgb *radiosities;    /* [sum of leaf_counts, and BALLOT_RECORDS more for each rank] */
};

/* Renews the routes of the solver, and sorts its links. Pre: all ranks have the same trees. */
void routes_renew(struct solver *solver);
void routes_free(struct routes *routes);

#endif
