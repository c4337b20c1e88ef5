/* A block of memory for all ranks of a node, a computer with memory of its own: filled
 * once and only looked at from then on. Where ranks cannot share, each has a block to
 * itself. */
#ifndef MPI_NODE_H
#define MPI_NODE_H

#include <limits.h>

#include "mpi/comm.h"

/* When blocks are shared. The tests vary the policy; phr takes node_policy(). */
struct node_policy {
    size_t least_bytes; /* smaller blocks are not shared */
    int ranks_max;      /* most ranks to share a block; 1: none do */
};

struct node_block {
    char *data;       /* [bytes], at a multiple of PACK_ALIGNMENT; read-only unless this
                         rank fills it */
    size_t bytes;
    bool fills;       /* this rank fills `data`; rank 0 always does */
    bool shared;      /* `data` is in a window; else in `memory` */
    double seconds;   /* spent on making the contents; 0 on ranks only receiving */
    void *memory;     /* owned, NULL if shared */
    MPI_Win window;
    struct comm node; /* the ranks sharing the block; only if shared */
};

static inline struct node_policy node_policy(void)
{
    return (struct node_policy){.least_bytes = (size_t)1 << 20, .ranks_max = INT_MAX};
}

/* Collective. A block of `bytes` bytes, the same number on all ranks. */
void node_block_create(struct node_block *block, const struct comm *comm, size_t bytes,
                       struct node_policy policy);

/* Collective. The contents of rank 0's block come to all. */
void node_block_spread(struct node_block *block, const struct comm *comm);

/* Collective over the ranks sharing the block. A block of zeros is none. */
void node_block_destroy(struct node_block *block);

#endif
