/* The state of a final gather on one rank: its mesh, its rows, and who has which. */
#ifndef MPI_BEYOND_GATHERING_H
#define MPI_BEYOND_GATHERING_H

#include "mpi/beyond/gather_mesh.h"
#include "mpi/beyond/stages.h"

/* What covers a leaf: faces in its plane, and things that stand on it. */
struct cover {
    double outside; /* share that is not inside of things, 1 */
    double bare;    /* area, less such faces' share of that, square scene units */
    double kept;    /* share of its light that arrives on fronts, 1 */
};

/* A leaf too near for some. */
struct too_near {
    int64_t leaf;     /* number */
    struct rgb shown; /* B as seen from afar over its mean, 1 */
};

/* Leaves have numbers, in the order of forest_order(), the same on all ranks. Rows of a
 * rank are in the order of its leaves. */
struct gathering {
    struct solver *solver;
    struct final_gather *gather;
    struct gather_mesh *mesh; /* borrowed */
    int32_t *leaves;        /* [count] local numbers; borrowed from the mesh */
    double *areas;          /* [count] square scene units */
    struct cover *covers;   /* [count] */
    int64_t count;
    struct too_near *near;  /* [near_count], once numbered */
    int64_t near_count;
    bool closed;            /* hardly any ray of any rank escapes */
    struct rgb *spread;     /* [count] how light that is missing is spread, W/m^2 */
    struct rgb missing;     /* part of what left last that did not arrive, 1 */
    struct rgb *radiosity;  /* by place: radiosities to be gathered */
    struct rgb *all;        /* [count] buffer: a value of each row, rank by rank */
    int64_t bytes;          /* of values that ranks have exchanged so far */
    struct stages *stages;  /* borrowed: who has which rows */
};

/* The material of a leaf, by its number. */
static inline const struct material *gathering_material(const struct gathering *g,
                                                        int64_t leaf)
{
    return forest_material(g->solver->model.forest, g->leaves[leaf]);
}

/* Collective. Brings the value of each row, from `all`, to all ranks, by leaf number:
 * [count]. Rows lie where they were made, and all ranks know all vectors: this is the
 * only exchange of a product with the rows. */
static inline void gathering_share_rows(struct gathering *g, struct rgb *values)
{
    comm_share(g->solver->comm, g->all, g->stages->counts, g->stages->at, sizeof *g->all);
    g->bytes += g->count * (int64_t)sizeof *g->all;
    for (int64_t i = 0; i < g->count; i++)
        values[i] = g->all[g->stages->place[i]];
}

#endif
