/* Watching what links, patches and clusters need. */
#ifndef MPI_MEMORY_H
#define MPI_MEMORY_H

#include "mpi/solver.h"

/* Collective, on a new solver. The links of all ranks and one copy of patches and
 * clusters may take `limit` bytes; 0: links and a copy for every rank may take most of
 * what the machines of the run have, each of which has `machine` bytes (0: unknown, and
 * there is no limit). */
void memory_watch(struct solver *solver, int64_t limit, int64_t machine);

/* Bytes that so many links take, one copy of the rows of a final gather with `rays` rays
 * (0: none), and so many copies of patches and clusters. */
int64_t memory_needed(int copies, int rays, int64_t links, int64_t patches,
                      int64_t clusters);

/* True if there is room for so many links, a final gather, and for what splitting `prolific` of them adds
 * to `patches` patches. The same on all ranks. */
bool memory_has_room(const struct memory *memory, int64_t links, int64_t prolific,
                     int64_t patches, int64_t clusters);

#endif
