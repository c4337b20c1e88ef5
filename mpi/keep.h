/* Taking a run's progress out of the ranks, and putting it back on any number of them. */
#ifndef MPI_KEEP_H
#define MPI_KEEP_H

#include "mpi/solver.h"
#include "rad/progress.h"

/* Collective, between two passes: fills `progress` on rank 0; on the others it stays without trees. To
 * be released with progress_free() on all. */
void progress_collect(struct solver *solver, const struct vote *vote, struct progress *progress);

/* Receives links with patch numbers of the progress in place of local ones, in ascending order. */
typedef void link_sink(void *context, const struct link *links, int64_t count);

/* Collective: all links go to the sink of rank 0, each once; the other ranks' is not called. The
 * order of the links here changes. */
void links_collect(struct solver *solver, link_sink *sink, void *context);

/* Collective, on a solver that has homes but no links: what progress_collect() took. `progress` is
 * rank 0's and has passed progress_check(). Returns the local numbers of its patches, to be freed
 * with alloc_free(). */
int32_t *progress_restore(struct solver *solver, struct vote *vote, struct progress *progress);

/* Collective: each link of `links`, rank 0's with numbers of the progress, goes to the home of one of
 * its two roots. `order` is what progress_restore() returned, `count` the same on all ranks. */
void links_deal(struct solver *solver, const int32_t *order, struct link *links, int64_t count);

#endif
