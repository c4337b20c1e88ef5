/* Records from all ranks to rank 0.
 *
 * Each rank sends its records in pieces, one after the other, and goes on when rank 0 has
 * received the last. Rank 0 asks for the next piece of a rank only after taking all of
 * the one before; so it can merge sorted streams of any length in little memory.
 * Rejected: one MPI_Gatherv, which needs room for everything on rank 0 and int counts. */
#include "mpi/beyond/funnel.h"

#include "geom/alloc.h"

enum { PIECE = 4096 };

static void send_all(const struct comm *comm, const char *records, int64_t count,
                     size_t bytes)
{
    for (int64_t at = 0; at < count; at += PIECE) {
        int64_t now = count - at < PIECE ? count - at : PIECE;
        MPI_Request request;
        MPI_Isend(records + (size_t)at * bytes, (int)((size_t)now * bytes), MPI_BYTE, 0,
                  TAG_RECORDS, comm->handle, &request);
        comm_wait_message(&request);
    }
}

void funnel_start(struct funnel *funnel, const struct comm *comm, const void *records,
                  int64_t count, size_t bytes)
{
    int64_t *counts = comm_gather_each(comm, &count, sizeof count);
    *funnel = (struct funnel){.comm = comm, .bytes = bytes};
    if (comm->rank != 0) {
        send_all(comm, records, count, bytes);
    } else {
        funnel->spouts = alloc_array((size_t)comm->size, sizeof *funnel->spouts);
        funnel->spouts[0] = (struct spout){.records = records, .count = count};
        for (int r = 1; r < comm->size; r++) {
            char *piece = alloc_array(PIECE, bytes);
            funnel->spouts[r] = (struct spout){.records = piece, .piece = piece,
                                               .left = counts[r]};
        }
    }
    alloc_free(counts);
}

const void *funnel_next(struct funnel *funnel, int rank)
{
    struct spout *spout = &funnel->spouts[rank];
    if (spout->at == spout->count) {
        if (spout->left == 0)
            return NULL;
        spout->at = 0;
        spout->count = spout->left < PIECE ? spout->left : PIECE;
        spout->left -= spout->count;
        MPI_Request request;
        MPI_Irecv(spout->piece, (int)((size_t)spout->count * funnel->bytes), MPI_BYTE,
                  rank, TAG_RECORDS, funnel->comm->handle, &request);
        comm_wait_message(&request);
    }
    return spout->records + (size_t)spout->at * funnel->bytes;
}

void funnel_end(struct funnel *funnel)
{
    for (int r = 0; r < funnel->comm->size && funnel->spouts; r++)
        alloc_free(funnel->spouts[r].piece);
    alloc_free(funnel->spouts);
    *funnel = (struct funnel){0};
}
