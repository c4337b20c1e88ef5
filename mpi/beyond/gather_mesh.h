/* The mesh of a final gather, and the rays that each leaf of it is worth. */
#ifndef MPI_GATHER_MESH_H
#define MPI_GATHER_MESH_H

#include "mpi/solver.h"
#include "rad/beyond/final_gather.h"

/* Leaves by number: those that have an area, as in forest_order(). */
struct gather_mesh {
    int32_t *leaves; /* [count] local numbers */
    int *rays;       /* [count] to be fired for its row */
    bool *exact;     /* [count] may have exact rows */
    int *rank_of;    /* [count] that is to make its row */
    int64_t count;
    int64_t split;   /* leaves that were */
    int64_t traced;  /* rays and segments of looks on this rank */
};

/* Collective. Splits leaves over which light varies, as far as --max-level, --min-area and
 * --memory let it with so many links, and gives each leaf rays. False if a signal has
 * ended it, on any rank: then there is nothing but to free. */
bool gather_mesh_make(struct solver *solver, int64_t links, struct gather_mesh *mesh);
void gather_mesh_free(struct gather_mesh *mesh);

#endif
