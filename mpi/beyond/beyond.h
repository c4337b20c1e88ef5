/* The state of one rank that goes beyond the paper's. */
#ifndef MPI_BEYOND_BEYOND_H
#define MPI_BEYOND_BEYOND_H

#include "mpi/solver.h"
#include "rad/beyond/final_gather.h"
#include "rad/beyond/conjugate.h"

/* Conjugate gradients (rad/beyond/conjugate.c) on all ranks alike, but for the vectors. */
struct descent {
    struct conjugate vectors;
    bool fresh;            /* the links have changed: the next transfer is of B */
    bool diverged;         /* K is not positive: more is reflected than arrives */
    double gain;           /* largest row sum, at least 1 */
    double shrink;         /* largest row sum times reflectance */
    double weight;         /* 1 over the least factor of a closure */
    double share;          /* largest reflectance over that */
    double gamma[BANDS];   /* <z, z>, W^2 m^-2, */
    double gamma_before[BANDS]; /* and of the step before */
    double step_before[BANDS];
    double bound_residual; /* |z| is nowhere larger, W/m^2 */
    double bound_image;    /* the same of |K p| */
    double least_bend;     /* least <K z, z> / <z, z> seen */
};

/* Where --accuracy is; see mpi/accuracy.c. */
struct accuracy {
    int64_t rounds;  /* so far */
    bool clear;      /* the part of the mesh is more than doubt */
    double coarse, coarse_epsilon; /* the mesh's part of the error for an epsilon before, 0: none */
    enum hold hold;
};

/* The answer of the final gather. */
struct answer {
    struct gathered counts;
    float *error;    /* [patches] bound on the error of a leaf's B, for 95 % of leaves and all
                        bands, W/m^2; NULL: there was no final gather */
    struct rgb *straight; /* [patches] what leaves reflect of light straight from lamps,
                             W/m^2; NULL: there was no final gather */
    struct final_gather gather; /* without its rows, for light at any point */
};

struct beyond {
    struct cluster_tree *tree;    /* above the roots; NULL: none */
    struct node_block tree_block; /* what it looks into */
    struct caps caps;       /* factors of the leaves */
    struct descent descent;
    struct accuracy accuracy;
    struct answer answer;
};

/* Collective. A solver for the criterion, whatever it asks for. Borrows comm, scene and
 * octree. */
struct solver *beyond_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree, const struct criterion *criterion);

/* What a solver has beyond the paper's; makes an empty one where there is none. */
struct beyond *beyond_attach(struct solver *solver);

/* The answer of its final gather; an empty one where there is none. */
const struct answer *beyond_answer(const struct solver *solver);

/* Step 5, when links have changed: row sums of the links there are, and the closure. */
void caps_begin(struct solver *solver);

/* Collective. After the last iteration: the row sums over the links there are, into
 * `stats`. */
void solver_measure_row_sums(struct solver *solver, struct stats *stats);

/* Steps 6 and 8 by conjugate gradients. When there is no other iteration B takes the place
 * of rho z. */
void descent_push_pull(struct solver *solver);
struct vote descent_vote(struct solver *solver, const struct ballot *sum);

/* Step 9, phr's own, after the last vote: the final gather. What all leaves see is traced, and light
 * solved for by that; `vote` says of the light from then on. The same on all ranks. False
 * if a signal has ended it. Pre: there are clusters. */
bool solver_final_gather(struct solver *solver, struct vote *vote);

/* Step 9, if there is one, and with --accuracy the verdict on it: DONE; STOPPED by a signal; or AGAIN,
 * and then criterion and vote are those of the links, for more passes, or for this step with more
 * rays alone. */
enum finish solver_finish(struct solver *solver, struct vote *vote);

#endif
