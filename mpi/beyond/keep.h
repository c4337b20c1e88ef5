/* Taking a run's snapshot out of the ranks, and putting it back on any number of them. */
#ifndef MPI_BEYOND_KEEP_H
#define MPI_BEYOND_KEEP_H

#include "mpi/solver.h"
#include "rad/beyond/snapshot.h"

/* Collective, between two passes. Fills `snapshot` on rank 0; on the others the snapshot
 * stays without trees. To be released with snapshot_free() on all ranks. */
void snapshot_collect(struct solver *solver, const struct vote *vote,
                      struct snapshot *snapshot);

/* Receives links with patch numbers of the snapshot in place of local ones (clusters keep
 * theirs), in ascending order, and the ranks where they live. */
typedef void link_sink(void *context, const struct link *links, const int *owners,
                       int64_t count);

/* Collective. Hands all links to the sink of rank 0, each once; the sinks of the other
 * ranks are not called. The order of the links here changes. */
void links_collect(struct solver *solver, link_sink *sink, void *context);

/* Collective, on a solver with neither links nor homes. Puts back a snapshot of
 * snapshot_collect(): rank 0's, which has passed snapshot_check(). Returns the local
 * numbers of its patches, to be freed with alloc_free(). */
int32_t *snapshot_restore(struct solver *solver, struct vote *vote,
                          struct snapshot *snapshot);

/* Collective. Deals rank 0's `links`, which have patch numbers of the snapshot, to the
 * ranks in turn. `order` is the array of snapshot_restore(); `count` is the same on all
 * ranks. */
void links_deal(struct solver *solver, const int32_t *order, struct link *links,
                int64_t count);

#endif
