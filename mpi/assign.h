/* Step 3 of the paper's Sec. 3.2: which rank is home to which root patch. */
#ifndef MPI_ASSIGN_H
#define MPI_ASSIGN_H

#include <stdint.h>

/* Deals the roots to `ranks` ranks so that the sums of their weights are even:
 * owner[root] is the home of a root. A pure function, so all ranks get the same
 * answer. */
void roots_assign(const int64_t *weights, int32_t roots, int ranks, int *owner);

#endif
