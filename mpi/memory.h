/* The memory limit: links, patches and clusters are counted. */
#ifndef MPI_MEMORY_H
#define MPI_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

#include "mpi/comm.h"

struct memory {
    int64_t limit;    /* bytes, 0: none */
    int64_t reached;  /* the limit met by linking or refinement, 0: none */
    int copies;       /* of patches and clusters, counted against the limit */
    int rays;         /* of the final gather from a leaf of middling size */
    int64_t clusters; /* above the roots */
};

/* Collective. The links of all ranks and one copy of patches and clusters may take
 * `limit` bytes, or an eighth more than roots, their rows and clusters alone, if more; 0:
 * links and a copy for every rank may take most of the memory of the machines of the run,
 * each of which has `machine` bytes (0: unknown), and most of the `room` bytes of each
 * rank (0: no limit). */
void memory_watch(struct memory *memory, const struct comm *comm, int64_t roots,
                  int64_t limit, int64_t machine, int64_t room);

/* Bytes of links, of the rows of the final gather, and of `copies` copies of the patches
 * and clusters. */
int64_t memory_needed(const struct memory *memory, int copies, int64_t links,
                      int64_t patches);

/* True if there is room for these links, a final gather, and the children of `prolific`
 * of the patches. The same on all ranks. */
bool memory_has_room(const struct memory *memory, int64_t links, int64_t prolific,
                     int64_t patches);

#endif
