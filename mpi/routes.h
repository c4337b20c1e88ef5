/* What travels in every transfer of light over the same trees: flux to the homes of
 * patches, and radiosities back. Found out once, so that the transfers need no IDs, no
 * counts and no searching. */
#ifndef MPI_ROUTES_H
#define MPI_ROUTES_H

#include <stdint.h>

#include "geom/scene.h"
#include "mpi/comm.h"

struct solver;

/* Lists of local patch numbers, home by home; of each home roots in order, depth first:
 * the same on all ranks. */
struct routes {
    int32_t *receivers; /* [sum of receiver_counts] patches that can receive light */
    int32_t *leaves;    /* [sum of leaf_counts] leaves whose B can change */
    int *receiver_counts, *leaf_counts; /* [ranks] */
    int *receiver_at, *leaf_at;         /* [ranks] where those of a home begin */
    int *record_at; /* [ranks + 1] where its leaves and its ballot begin in `radiosities`
                     */
    int64_t *flux;           /* [3 * sum of receiver_counts] room for flux sent home */
    int64_t *own_flux;       /* [3 * receivers of this rank] room for its sums at home */
    struct rgb *radiosities; /* [record_at[ranks]] room for all leaves and ballots */
};

/* Renews the routes of the solver, and sorts its links. Pre: all ranks have the same
 * trees. */
void routes_renew(struct solver *solver);
void routes_free(struct routes *routes);

#endif
