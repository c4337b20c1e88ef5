/* The ranks.
 *
 * MPICH and Open MPI wait by polling without pause. With fewer cores than ranks a
 * blocking collective then holds the core needed by the rank it waits for, and an 8-byte
 * reduction takes tens of milliseconds. So every collective here is the non-blocking one,
 * tested in a loop that soon yields the processor and later sleeps: where each rank has a
 * core of its own the first tests succeed and nothing is lost.
 *
 * Yielding alone is not enough with many ranks: the scheduler may hand the core to
 * another waiting rank, again and again. Hence the sleep, short beside a refinement
 * level, and longer the longer a rank has waited: while rank 0 writes, the others are not
 * to wake all the time. Where there are as many processors as ranks the sleep begins
 * late: an exchange goes on in steps, each when a rank tests, and a sleeper holds up all.
 * On 16 cores rooms take .55 and .7 of the time, a Cornell box half of it. */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200112L
#include <sched.h>
#include <time.h>
#include <unistd.h>
#define HAVE_YIELD 1
#endif

#include "mpi/comm.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "geom/alloc.h"

enum {
    TESTS_BEFORE_YIELD = 100,
    TESTS_BEFORE_SLEEP = 200,
    TESTS_WITH_PROCESSORS = 10000, /* the same, if each rank has one */
    SHORTEST_SLEEP = 20, /* microseconds */
    LONGEST_SLEEP = 1000,
    SLEEP_GROWTH = 4, /* microseconds for each test in vain */
    LARGE = 1 << 17   /* bytes; larger arrays go back to the system when freed */
};

/* For the handler of exhausted memory, which has no argument. */
static MPI_Comm failing_comm;

static int all_ranks; /* size of the first communicator */
static int was_there; /* MPI was initialised by the program around */
static int tests_before_sleep = TESTS_BEFORE_SLEEP;
static struct comm_counts counted;

static void out_of_memory(size_t bytes)
{
    fprintf(stderr, "%s: out of memory (%zu bytes more were needed)\n", error_program,
            bytes);
    MPI_Abort(failing_comm, EXIT_FAILED);
}

void comm_start(struct comm *comm, int *argc, char ***argv)
{
    MPI_Request request;
#ifdef M_MMAP_THRESHOLD
    mallopt(M_MMAP_THRESHOLD, LARGE); /* or it grows to the largest array freed so far */
#endif
    MPI_Initialized(&was_there);
    if (!was_there)
        MPI_Init(argc, argv);
    MPI_Comm_idup(MPI_COMM_WORLD, &comm->handle, &request);
    comm_wait(&request);
    MPI_Comm_rank(comm->handle, &comm->rank);
    MPI_Comm_size(comm->handle, &comm->size);
    all_ranks = comm->size;
#ifdef _SC_NPROCESSORS_ONLN
    if (all_ranks <= sysconf(_SC_NPROCESSORS_ONLN))
        tests_before_sleep = TESTS_WITH_PROCESSORS;
#endif
    failing_comm = comm->handle;
    alloc_on_failure(out_of_memory);
}

void comm_stop(struct comm *comm)
{
    MPI_Request request;
    MPI_Ibarrier(comm->handle, &request);
    comm_wait(&request);
    alloc_on_failure(NULL);
    MPI_Comm_free(&comm->handle);
    if (!was_there)
        MPI_Finalize();
}

static void leave_processor(int tests)
{
#ifdef HAVE_YIELD
    if (tests > tests_before_sleep) {
        long sleep = SHORTEST_SLEEP + (long)SLEEP_GROWTH * (tests - tests_before_sleep);
        struct timespec pause = {0,
                                 1000 * (sleep < LONGEST_SLEEP ? sleep : LONGEST_SLEEP)};
        nanosleep(&pause, NULL);
    } else if (tests > TESTS_BEFORE_YIELD) {
        sched_yield();
    }
#else
    (void)tests;
#endif
}

static void wait_for(MPI_Request *request)
{
    int done = 0;
    for (int tests = 0; !done; tests += tests < INT_MAX) {
        MPI_Test(request, &done, MPI_STATUS_IGNORE);
        if (!done)
            leave_processor(tests);
    }
}

void comm_wait(MPI_Request *request)
{
    counted.collectives++;
    for (int reached = 1; reached < all_ranks; reached *= 2)
        counted.messages++;
    wait_for(request);
}

void comm_wait_message(MPI_Request *request)
{
    counted.messages++;
    wait_for(request);
}

void comm_broadcast(const struct comm *comm, void *buffer, size_t bytes)
{
    const size_t chunk = (size_t)1 << 26;
    char *at = buffer;
    for (size_t left = bytes; left > 0;) {
        size_t now = left < chunk ? left : chunk;
        MPI_Request request;
        MPI_Ibcast(at, (int)now, MPI_BYTE, 0, comm->handle, &request);
        comm_wait(&request);
        at += now;
        left -= now;
    }
}

void comm_add(const struct comm *comm, int64_t *numbers, int64_t count)
{
    MPI_Request request;
    MPI_Iallreduce(MPI_IN_PLACE, numbers, comm_count(comm, count), MPI_INT64_T, MPI_SUM,
                   comm->handle, &request);
    comm_wait(&request);
}

double comm_largest(const struct comm *comm, double value)
{
    double largest;
    MPI_Request request;
    MPI_Iallreduce(&value, &largest, 1, MPI_DOUBLE, MPI_MAX, comm->handle, &request);
    comm_wait(&request);
    return largest;
}

void *comm_gather_each(const struct comm *comm, const void *own, size_t bytes)
{
    void *all = alloc_array((size_t)comm->size, bytes);
    MPI_Request request;
    int count = comm_count(comm, (int64_t)bytes);
    MPI_Iallgather(own, count, MPI_BYTE, all, count, MPI_BYTE, comm->handle, &request);
    comm_wait(&request);
    return all;
}

bool comm_agree(const struct comm *comm, struct error *error)
{
    struct error *all = comm_gather_each(comm, error, sizeof *error);
    for (int r = comm->size - 1; r >= 0; r--)
        if (all[r].code != EXIT_DONE)
            *error = all[r];
    alloc_free(all);
    return error->code == EXIT_DONE;
}

int comm_count(const struct comm *comm, int64_t count)
{
    if (count > INT_MAX) {
        fprintf(stderr,
                "%s: a message of %lld items is more than MPI can count; a larger "
                "epsilon makes it smaller\n",
                error_program, (long long)count);
        MPI_Abort(comm->handle, EXIT_FAILED);
    }
    return (int)count;
}

int64_t comm_displacements(const struct comm *comm, const int *counts, int *displacements)
{
    int64_t sum = 0;
    for (int r = 0; r < comm->size; r++) {
        displacements[r] = comm_count(comm, sum);
        sum += counts[r];
    }
    return comm_count(comm, sum);
}

/* Whole records, to keep counts small. */
static MPI_Datatype record_of(size_t bytes)
{
    MPI_Datatype record;
    MPI_Type_contiguous((int)bytes, MPI_BYTE, &record);
    MPI_Type_commit(&record);
    return record;
}

/* One message to each rank with records to get: no count is too large for MPI, and ranks
 * with nothing for each other need not meet. The records of a rank for itself are
 * copied. */
void comm_deliver(const struct comm *comm, const void *records, const int *counts,
                  void *arriving, const int *expected, size_t bytes)
{
    MPI_Datatype record = record_of(bytes);
    MPI_Request *requests = alloc_array(2 * (size_t)comm->size, sizeof *requests);
    const char *out = records;
    char *in = arriving;
    int messages = 0;
    for (int r = 0; r < comm->size; r++) {
        bool is_other = r != comm->rank;
        if (!is_other && counts[r] > 0)
            memcpy(in, out, (size_t)counts[r] * bytes);
        if (is_other && expected[r] > 0)
            MPI_Irecv(in, expected[r], record, r, TAG_EXCHANGE, comm->handle,
                      &requests[messages++]);
        if (is_other && counts[r] > 0)
            MPI_Isend(out, counts[r], record, r, TAG_EXCHANGE, comm->handle,
                      &requests[messages++]);
        in += (size_t)expected[r] * bytes;
        out += (size_t)counts[r] * bytes;
    }
    for (int i = 0; i < messages; i++)
        comm_wait_message(&requests[i]);
    MPI_Type_free(&record);
    alloc_free(requests);
}

void *comm_exchange(const struct comm *comm, const void *records, const int *counts,
                    size_t bytes, int *expected, int64_t *arriving)
{
    MPI_Request request;
    MPI_Ialltoall(counts, 1, MPI_INT, expected, 1, MPI_INT, comm->handle, &request);
    comm_wait(&request);
    *arriving = 0;
    for (int r = 0; r < comm->size; r++)
        *arriving += expected[r];
    void *arrived = alloc_array((size_t)*arriving, bytes);
    comm_deliver(comm, records, counts, arrived, expected, bytes);
    return arrived;
}

void comm_share(const struct comm *comm, void *records, const int *counts, const int *at,
                size_t bytes)
{
    MPI_Datatype record = record_of(bytes);
    MPI_Request request;
    MPI_Iallgatherv(MPI_IN_PLACE, 0, record, records, counts, at, record, comm->handle,
                    &request);
    comm_wait(&request);
    MPI_Type_free(&record);
}

void *comm_gather_all(const struct comm *comm, const void *own, int64_t count,
                      size_t bytes, int64_t *all)
{
    int number = comm_count(comm, count);
    int *counts = comm_gather_each(comm, &number, sizeof number);
    int *at = alloc_array((size_t)comm->size, sizeof *at);
    *all = comm_displacements(comm, counts, at);
    char *records = alloc_array((size_t)*all, bytes);
    if (number > 0)
        memcpy(records + (size_t)at[comm->rank] * bytes, own, (size_t)number * bytes);
    comm_share(comm, records, counts, at, bytes);
    alloc_free(at);
    alloc_free(counts);
    return records;
}

const char *comm_build(void)
{
#ifdef MPI_SERIAL_MPI_H
    return "serial";
#else
    return "MPI";
#endif
}

struct comm_counts comm_counts(void)
{
    return counted;
}

double comm_seconds(void)
{
    return MPI_Wtime();
}
