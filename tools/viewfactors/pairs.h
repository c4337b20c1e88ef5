/* View factors on all ranks: pairs of roots are dealt, exchanges are summed. */
#ifndef TOOLS_VIEWFACTORS_PAIRS_H
#define TOOLS_VIEWFACTORS_PAIRS_H

#include "geom/progress.h"
#include "mpi/comm.h"
#include "tools/viewfactors/viewfactor.h"

/* Collective. Adds all pairs of roots facing each other to `factors`, which are equal on
 * all ranks and new, or taken back in part by viewfactors_refine(). All ranks end with
 * the same exchanges; counts and links are the rank's alone. Ticks `progress`, which may
 * be NULL. Ends early, on all ranks, if one is asked to stop. */
void pairs_add(const struct comm *comm, struct viewfactors *factors,
               struct progress *progress);

#endif
