/* Step 3 of the paper's Sec. 3.2: which rank is home to which root patch. */
#ifndef MPI_ASSIGN_H
#define MPI_ASSIGN_H

#include <stdint.h>

/* Deals `count` items, such as roots, to `ranks` ranks with even sums of weights: item i
 * goes to owner[i]. A pure function: all ranks get the same answer. */
void items_deal(const int64_t *weights, int32_t count, int ranks, int *owner);

#endif
