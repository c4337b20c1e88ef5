/* View factors of bodies of thousands of facets, by rays. */
#ifndef TOOLS_VIEWFACTORS_BODIES_H
#define TOOLS_VIEWFACTORS_BODIES_H

#include "mpi/comm.h"
#include "tools/viewfactors/viewfactor.h"

/* Rays of a group, at first and at most: 16 batches of a sequence. */
enum { BODIES_RAYS = 1 << 16, BODIES_RAYS_MOST = 1 << 26 };

/* True if rays from each group cost less than pairs of roots. */
bool bodies_are_meant(const struct viewfactors *factors);

/* Collective. Sets all exchanges by this many rays from each group, a multiple of 16; the
 * variances are told by the spread of the batches. All ranks end with the same. Ends
 * early, without a meaning, if a rank is asked to stop. */
void bodies_set(const struct comm *comm, struct viewfactors *factors, int64_t rays);

#endif
