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
    double weight;         /* largest closure_weight(), at least 1 */
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
    struct closure closure;       /* factors of the leaves */
    struct descent descent;
    struct accuracy accuracy;
    struct answer answer;
};

#endif
