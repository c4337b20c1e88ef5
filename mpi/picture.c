/* Gathering a picture: rank 0 receives row by row, each where it belongs. So there is no
 * copy but the rows of each rank, and none where rank 0 is alone. */
#include "mpi/picture.h"

#include <string.h>

#include "geom/alloc.h"

float *picture_gather(const struct comm *comm, float *rows, size_t row, int height)
{
    if (comm->size == 1)
        return rows;
    float *picture =
        comm->rank == 0 ? alloc_array((size_t)height * row, sizeof *picture) : NULL;
    const float *next = rows;
    for (int y = 0, floats = comm_count(comm, (int64_t)row); y < height; y++) {
        int from = y % comm->size;
        float *place = picture ? picture + (size_t)y * row : NULL;
        MPI_Request request = MPI_REQUEST_NULL;
        if (place && from > 0)
            MPI_Irecv(place, floats, MPI_FLOAT, from, TAG_SCANLINE, comm->handle,
                      &request);
        else if (place)
            memcpy(place, next, row * sizeof *place);
        else if (from == comm->rank)
            MPI_Isend(next, floats, MPI_FLOAT, 0, TAG_SCANLINE, comm->handle, &request);
        if (request != MPI_REQUEST_NULL)
            comm_wait_message(&request);
        next += from == comm->rank ? row : 0;
    }
    alloc_free(rows);
    return picture;
}
