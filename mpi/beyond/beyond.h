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
    float *outside;       /* [patches] share of a leaf outside of things on it and of
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

/* Collective. Creates a solver for any criterion. Borrows comm, scene and octree. */
struct solver *beyond_create(const struct comm *comm, const struct scene *scene,
                             const struct octree *octree,
                             const struct criterion *criterion);

/* Returns solver->beyond; creates an empty one where there is none. */
struct beyond *beyond_attach(struct solver *solver);

/* Frees the vectors for transfers of light, after the last transfer. */
void beyond_free_vectors(struct solver *solver);

/* The answer of the final gather; an empty one where there is none. */
const struct answer *beyond_answer(const struct solver *solver);

/* The tree above the roots, the same on all ranks; collective. Builds
 * solver->beyond->tree, and the light and the arrays of a tree. */
void above_create(struct solver *solver);
void above_free(struct solver *solver);

/* Step 3 with a tree: homes of roots and of clusters. */
void above_deal(struct solver *solver, int *owner);

/* Step 5, before a transfer: clears the flux of clusters, and averages a vector that is
 * not the light of step 7. Returns these means, for above_end(), after the transfer.
 * Collective, then: sums flux and pushes it down to the own roots. */
struct rgb *above_begin(struct solver *solver, const struct rgb *vector);
void above_end(struct solver *solver, struct rgb *means);
void above_collect(struct solver *solver);

/* Collective. Step 4, before a pass and before its levels: bounds on the light of the
 * ends of links. */
void bounds_prepare(struct solver *solver);
void bounds_learn(struct solver *solver, const struct route *originals,
                  const struct route *proxies);

/* Collective. Step 7 with a tree. */
void above_scatter(struct solver *solver);

/* Steps 5 and 8 with conjugate residuals: when links have changed; and after each
 * iteration. */
void descent_begin(struct solver *solver);
struct vote descent_vote(struct solver *solver, const struct ballot *sum);

/* Collective. Step 9, phr's own, after the last vote: the final gather. Traces rows for
 * all leaves and solves for light by them; from then on `vote` is on this light. Returns
 * false on all ranks if a signal has ended the step. Pre: there are clusters. */
bool solver_final_gather(struct solver *solver, struct vote *vote);

/* Collective. Step 9, if there is one, and with --accuracy the verdict on its answer.
 * After FINISH_AGAIN criterion and vote are those of the links, for more passes, or for
 * this step again with more rays. */
enum finish solver_finish(struct solver *solver, struct vote *vote);

#endif
