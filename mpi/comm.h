/* The ranks: one communicator, waiting that yields, and agreement on errors. */
#ifndef MPI_COMM_H
#define MPI_COMM_H

#include <stddef.h>
#include <stdint.h>
#include <mpi.h>

#include "geom/error.h"

struct comm {
    MPI_Comm handle; /* a duplicate of MPI_COMM_WORLD */
    int rank, size;
};

/* Initialises MPI if nobody has; from here on, running out of memory ends all ranks with
 * exit code 1. */
void comm_start(struct comm *comm, int *argc, char ***argv);

/* Collective. Waits for all ranks, and finalises MPI if comm_start() initialised MPI. */
void comm_stop(struct comm *comm);

/* Messages from one rank to another. Those of one tag never overtake each other. */
enum comm_tag { TAG_RECORDS = 1, TAG_SCANLINE, TAG_EXCHANGE };

/* Waits for a collective operation, or for a message to or from one rank, without
 * blocking, and leaves the processor to others meanwhile. */
void comm_wait(MPI_Request *request);
void comm_wait_message(MPI_Request *request);

/* Collective. Rank 0's bytes go to all; any size. */
void comm_broadcast(const struct comm *comm, void *buffer, size_t bytes);

/* Collective. Each of `count` numbers becomes its sum over all ranks. */
void comm_add(const struct comm *comm, int64_t *numbers, int64_t count);

/* Collective. The largest value over all ranks. */
double comm_largest(const struct comm *comm, double value);

/* Collective. All ranks end with the error of the lowest rank with one. True if none
 * has. */
bool comm_agree(const struct comm *comm, struct error *error);

/* A count as an int, for MPI. A count too large is fatal: exit code 1. */
int comm_count(const struct comm *comm, int64_t count);

/* displacements[r] = counts[0] + ... + counts[r - 1]. Returns the sum of all counts. */
int64_t comm_displacements(const struct comm *comm, const int *counts,
                           int *displacements);

/* Collective. Records go to ranks with known counts: counts[0] for rank 0, then
 * counts[1] for rank 1, and so on; expected[r] of rank r arrive, in the order of the
 * ranks. Records have `bytes` bytes, without padding. */
void comm_deliver(const struct comm *comm, const void *records, const int *counts,
                  void *arriving, const int *expected, size_t bytes);

/* Collective. Total exchange of records of `bytes` bytes without padding: `records` holds
 * counts[0] for rank 0, then counts[1] for rank 1, and so on. Returns what arrives, in
 * the order of the ranks, to be freed with alloc_free(); expected[r] records of rank r,
 * `*arriving` in all. */
void *comm_exchange(const struct comm *comm, const void *records, const int *counts,
                    size_t bytes, int *expected, int64_t *arriving);

/* Collective. All ranks get the records of all: counts[r] of rank r begin at[r] records
 * behind `records`; each rank's own are in place. */
void comm_share(const struct comm *comm, void *records, const int *counts, const int *at,
                size_t bytes);

/* Collective. The records of all ranks, one of `bytes` bytes of each, on all ranks. To be
 * freed with alloc_free(). */
void *comm_gather_each(const struct comm *comm, const void *own, size_t bytes);

/* Collective. The records of all ranks, `count` of `bytes` bytes of this one, in the
 * order of the ranks, on all ranks: `*all` of them. To be freed with alloc_free(). */
void *comm_gather_all(const struct comm *comm, const void *own, int64_t count,
                      size_t bytes, int64_t *all);

/* "MPI", or "serial" where mpi/serial/mpi.h takes its place. */
const char *comm_build(void);

/* Operations waited for by this rank. */
struct comm_counts {
    int64_t collectives;
    int64_t messages; /* log P for a collective of P ranks, and those to and from one */
};

struct comm_counts comm_counts(void);

/* Seconds since some moment in the past. */
double comm_seconds(void);

#endif
