/* Gathering a picture: rank 0 receives the rows of rank 0, then those of rank 1, and so
 * on, and puts each in its place. Of large pictures there are no more than two copies at
 * a time, and one where rank 0 is alone. */
#include "mpi/picture.h"

#include <string.h>

#include "geom/alloc.h"

float *picture_gather(const struct comm *comm, float *rows, size_t row, int height)
{
    if (comm->size == 1)
        return rows;
    size_t ranks = (size_t)comm->size;
    int *counts = alloc_array(ranks, sizeof *counts),
        *at = alloc_array(ranks, sizeof *at);
    for (int y = 0; y < height; y++)
        counts[y % comm->size]++;
    comm_displacements(comm, counts, at);
    MPI_Datatype record;
    MPI_Type_contiguous(comm_count(comm, (int64_t)row), MPI_FLOAT, &record);
    MPI_Type_commit(&record);
    bool collects = comm->rank == 0;
    float *all = collects ? alloc_array((size_t)height * row, sizeof *all) : NULL;
    MPI_Request request;
    MPI_Igatherv(rows, counts[comm->rank], record, all, counts, at, record, 0,
                 comm->handle, &request);
    comm_wait(&request);
    MPI_Type_free(&record);
    alloc_free(rows);
    float *picture = collects ? alloc_array((size_t)height * row, sizeof *picture) : NULL;
    for (int y = 0; y < height && collects; y++) {
        int place = at[y % comm->size] + y / comm->size;
        memcpy(picture + (size_t)y * row, all + (size_t)place * row,
               row * sizeof *picture);
    }
    alloc_free(all);
    alloc_free(at);
    alloc_free(counts);
    return picture;
}
