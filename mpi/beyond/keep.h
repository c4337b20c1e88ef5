/* Taking a run's snapshot out of the ranks, and putting it back on any number of them. */
#ifndef MPI_KEEP_H
#define MPI_KEEP_H

#include "mpi/solver.h"
#include "rad/beyond/snapshot.h"

/* Collective, between two passes: fills `snapshot` on rank 0; on the others it stays without trees. To
 * be released with snapshot_free() on all. */
void snapshot_collect(struct solver *solver, const struct vote *vote, struct snapshot *snapshot);

/* Receives links with patch numbers of the snapshot in place of local ones (clusters keep
 * theirs), in ascending order. */
typedef void link_sink(void *context, const struct link *links, int64_t count);

/* Collective: all links go to the sink of rank 0, each once; the other ranks' is not called. The
 * order of the links here changes. */
void links_collect(struct solver *solver, link_sink *sink, void *context);

/* Collective, on a solver that has neither links nor homes: what snapshot_collect() took. `snapshot` is
 * rank 0's and has passed snapshot_check(). Returns the local numbers of its patches, to be freed
 * with alloc_free(). */
int32_t *snapshot_restore(struct solver *solver, struct vote *vote, struct snapshot *snapshot);

/* Collective: the links of `links`, rank 0's with numbers of the snapshot, are dealt to the ranks in
 * turn. `order` is what snapshot_restore() returned, `count` the same on all ranks. */
void links_deal(struct solver *solver, const int32_t *order, struct link *links, int64_t count);

#endif
