/* Bringing together a picture rendered in rows by all ranks. */
#ifndef MPI_PICTURE_H
#define MPI_PICTURE_H

#include "mpi/comm.h"

/* Collective. `rows` are this rank's rows rank, rank + size, ... of a picture of `height`
 * rows of `row` floats each. Takes `rows` over. Returns the whole picture, top row first,
 * on rank 0 (to be freed with alloc_free()), NULL on the others. */
float *picture_gather(const struct comm *comm, float *rows, size_t row, int height);

#endif
