/* The state of one rank beyond the paper's. */
#ifndef MPI_BEYOND_BEYOND_H
#define MPI_BEYOND_BEYOND_H

#include "mpi/solver.h"
#include "rad/beyond/gather/gather.h"
#include "rad/beyond/conjugate.h"

/* The state of --accuracy; see mpi/beyond/accuracy.c. */
struct accuracy {
    int64_t rounds;        /* so far */
    bool clear;            /* the mesh's part of the error exceeds the doubt */
    double coarse;         /* the mesh's part of the error for coarse_epsilon */
    double coarse_epsilon; /* an epsilon of a round before; 0: none */
    enum hold hold;        /* the limit ending the rounds */
};

/* The answer of the final gather. */
struct answer {
    struct gathered counts;
    float *error;         /* [patches] bound on the error of a leaf's B, for 95 % of
                             leaves and all bands, W/m^2; NULL: there is no answer */
    struct rgb *straight; /* [patches] light straight from lamps, as a leaf reflects it,
                             W/m^2; NULL: there is no answer */
    float *open;          /* [patches] share of a leaf outside of things on it and of
                             narrow gaps, 1; NULL: there is no answer */
    struct final_gather *gather; /* without its rows, for light at any point; NULL: there
                                    is no answer */
};

/* The tree above the roots, dealt: see mpi/beyond/above.c. Clusters by number. */
struct branches {
    int *owner;    /* [clusters] see struct clusters */
    int32_t *top;  /* [top_count] clusters above the branches, parents first */
    int32_t *own;  /* [own_count] clusters at home here, parents first */
    int32_t top_count, own_count;
    struct route all; /* the branches, clusters and roots, home by home */
};

/* The state of a rank beyond the paper's. */
struct beyond {
    struct spaces *spaces;        /* NULL: there is no tree */
    struct cluster_tree *tree;    /* above the roots; NULL: none */
    struct branches *branches;    /* NULL: none */
    struct node_block tree_block; /* the memory of a tree that is a view */
    struct conjugate *descent;
    void (*scatter)(struct solver *solver); /* step 7, of the light of the descent */
    struct accuracy accuracy;
    struct answer *answer;
};

/* Returns solver->beyond; creates an empty one where there is none. */
struct beyond *beyond_attach(struct solver *solver);

/* Makes the answer an empty one. */
void answer_clear(struct answer *answer);

/* Frees the vectors for transfers of light, after the last transfer. */
void beyond_free_vectors(struct solver *solver);

/* The answer of the final gather; an empty one where there is none. */
const struct answer *beyond_answer(const struct solver *solver);

#endif
