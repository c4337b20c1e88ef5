/* The state of a final gather on one rank: its mesh, its rows, and who has which. */
#ifndef MPI_BEYOND_GATHERING_H
#define MPI_BEYOND_GATHERING_H

#include <string.h>

#include "mpi/beyond/mesh.h"
#include "mpi/beyond/stages.h"

/* What covers a leaf: faces in its plane, and things standing on the leaf. The first four
 * as in a row. */
struct cover {
    float outside; /* share outside of things, 1 */
    float open;    /* share outside of narrow gaps, too, 1 */
    float part;    /* share of `outside` not covered by a face in its plane, 1 */
    float kept;    /* share of its light arriving on fronts, 1 */
    double bare;   /* area times `part`, square scene units */
};

/* A leaf too near for some. */
struct too_near {
    int64_t leaf;     /* number */
    struct rgb shown; /* B as seen from afar over its mean, 1 */
};

/* Light of the surfaces of a space, W in square scene units; factors of a balance. */
struct flows {
    struct rgb leaving, arriving; /* W; or emitted and absorbed */
    struct rgb spread;            /* as irradiance is spread, W */
    struct rgb missing;           /* part of the light last leaving that did not arrive */
    double unsure;                /* part of B that light may be off by in the end */
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
    bool apart;             /* no row sees another space than its leaf's */
    bool balanced;          /* some space is closed */
    bool *closed;           /* [lit_count()] hardly any ray of a space escapes, or no
                             * light */
    int64_t *fired;         /* [2 * lit_count()] rays of each space, and those escaping */
    struct flows *flows;    /* [lit_count()] */
    struct rgb *spread;     /* [count] how missing light is spread, W/m^2 a ray */
    struct rgb *radiosity;  /* by place: radiosities to be gathered */
    struct rgb *all;        /* [count] buffer: a value of each row, rank by rank */
    int64_t bytes;          /* of values exchanged by ranks so far */
    struct stages *stages;  /* borrowed: who has which rows */
};

/* The material of a leaf, by its number. */
static inline const struct material *gathering_material(const struct gathering *g,
                                                        int64_t leaf)
{
    return forest_material(g->solver->model.forest, g->leaves[leaf]);
}

/* The space of a leaf, by its number. */
static inline int32_t gathering_space(const struct gathering *g, int64_t leaf)
{
    return node_space(&g->solver->model, g->leaves[leaf]);
}

/* The balance of which a leaf is part, an index of `flows` and `closed`. */
static inline int32_t gathering_balance(const struct gathering *g, int64_t leaf)
{
    return g->apart ? gathering_space(g, leaf) : 0;
}

/* Collective. Brings the value of each row, from `all`, to all ranks, by leaf number:
 * [count]. Rows lie where made, and all ranks know all vectors: this is the only exchange
 * of a product with the rows. */
static inline void gathering_share_rows(struct gathering *g, struct rgb *values)
{
    comm_share(g->solver->comm, g->all, g->stages->counts, g->stages->at, sizeof *g->all);
    g->bytes += g->count * (int64_t)sizeof *g->all;
    for (int64_t i = 0; i < g->count; i++)
        values[i] = g->all[g->stages->place[i]];
}

/* Collective. Brings a field of each row, `offset` bytes from its beginning, to all
 * ranks: at most an rgb. */
static inline void gathering_share_field(struct gathering *g, size_t offset, size_t bytes,
                                         struct rgb *values)
{
    struct rgb *own = g->all + g->stages->at[g->solver->comm->rank];
    for (int64_t row = 0; row < g->gather->count; row++)
        memcpy(&own[row], (const char *)&g->gather->rows[row] + offset, bytes);
    gathering_share_rows(g, values);
}

/* Collective. A bound on the error of B of 95 % of leaves, W/m^2, by the largest
 * deviation of a band, and the RMS of deviations by rays and by the mesh: both go into
 * the solver's answer. `remaining`: what the solution may lack, in parts of B.
 * Pre: g->radiosity is the solution. */
void gathering_estimate_errors(struct gathering *g, double remaining);

/* The deviation of which `error`, of a leaf, is the bound. */
double gathering_deviation(double error);

#endif
