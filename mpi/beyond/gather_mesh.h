/* The mesh of a final gather, and the rays that each leaf is worth. */
#ifndef MPI_BEYOND_GATHER_MESH_H
#define MPI_BEYOND_GATHER_MESH_H

#include "mpi/solver.h"
#include "rad/beyond/gather/gather.h"

/* The leaves with an area, in the order of forest_order(). */
struct gather_mesh {
    int32_t *leaves; /* [count] local numbers */
    int *rays;       /* [count] to be fired for the row */
    int *segments;   /* [count] to be fired at lamps */
    bool *exact;     /* [count] the row may be exact */
    int64_t *work;   /* [count] predicted for the row, in tests */
    int64_t count;
    uint8_t *cut;    /* [forest->count] 1: a thing stands on the patch, or across it */
    int64_t cut_capacity;
    int64_t split;   /* leaves split */
    bool limited;    /* the memory limit has kept others from being split */
    int64_t traced;  /* rays and segments of looks on this rank */
};

/* Collective. Splits leaves over which light varies, as far as --max-level, --min-area
 * and --memory allow with `links` links, and gives each leaf rays. False if a signal on
 * any rank has ended the work: then the mesh can only be freed. */
bool gather_mesh_make(struct solver *solver, int64_t links, struct gather_mesh *mesh);
void gather_mesh_free(struct gather_mesh *mesh);

/* Collective. Returns 1 for each root proved to have nothing between itself and the roots
 * it faces, else 0: [roots], to be freed. All are 0 if the open ones have less than half
 * of the scene's area. Enters the work into the ledger. */
uint8_t *gather_find_open_roots(struct solver *solver, struct final_gather *gather);

/* Shares shots in proportion to `worth`, [count], in any unit: `shots`, [count], at least
 * 4 each, and 4 where the worth is -1, none. The sum of the others is `mean` times their
 * number at most, unless these 4 are too many; all are `mean` if all are worth 0. */
void gather_share_shots(const double *worth, int64_t count, int mean, int *shots);

#endif
