/* Step 3 of the paper's Sec. 3.2: which rank is home to which root patch. */
#ifndef MPI_ASSIGN_H
#define MPI_ASSIGN_H

#include "geom/scene.h"

/* Deals the roots to `ranks` ranks so that the sums of their areas are even: owner[root] is the
 * home of a root. A pure function of the scene, so all ranks get the same answer. */
void roots_assign(const struct scene *scene, int ranks, int *owner);

#endif
