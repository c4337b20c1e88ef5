/* One copy per node.
 *
 * The ranks of a node find each other with MPI_Comm_split_type(), and one of them asks
 * for a window of MPI_Win_allocate_shared() for the whole block, since implementations
 * limit the number of windows. This rank writes; the others begin to look after a
 * barrier. MPI_Win_sync() on either side of the barrier orders the stores and the loads;
 * the epoch for these calls, lock_all, is open as long as the window is.
 *
 * Splitting a communicator and making a window are blocking calls, there are no others.
 * On fewer cores than ranks MPICH needs a second or two for both (16 ranks on 2 cores;
 * mpi/comm.c says why), so small blocks, which save nothing, are not shared.
 *
 * A window may be refused, and it may be granted and not be there: a window is a file in
 * a file system in memory, which in containers is often small, and a page without room is
 * a SIGBUS at the first touch. So the rank that fills the window touches all of it, ready
 * for this signal, before the others hear of a window. All ranks of a node have the
 * window or none does, and then each has memory of its own. Nothing remains of a killed
 * run: the file has no name by the time the window is there, with MPICH and Open MPI.
 *
 * Patches are not shared, although there are more of them: every rank adds to its forest
 * during refinement, in an order of its own, and links hold local indices. */
#if defined(__unix__) || defined(__APPLE__)
#define _POSIX_C_SOURCE 200112L
#include <setjmp.h>
#include <signal.h>
#define HAVE_SIGBUS 1
#endif

#include "mpi/node.h"

#include <limits.h>
#include <string.h>

#include "geom/alloc.h"
#include "geom/pack.h"

enum { SPREAD_CHUNK = 1 << 20 }; /* bytes */

/* Bytes from `data` to where a block may begin. */
static int gap_of(const char *data)
{
    return (int)((PACK_ALIGNMENT - (uintptr_t)data % PACK_ALIGNMENT) % PACK_ALIGNMENT);
}

static struct comm comm_of(MPI_Comm handle)
{
    struct comm comm = {.handle = handle};
    MPI_Comm_rank(handle, &comm.rank);
    MPI_Comm_size(handle, &comm.size);
    return comm;
}

/* Collective. The ranks that may share a block with this one. */
static struct comm find_node(const struct comm *comm, int ranks_max)
{
    MPI_Comm handle, part;
    MPI_Comm_split_type(comm->handle, MPI_COMM_TYPE_SHARED, comm->rank, MPI_INFO_NULL,
                        &handle);
    struct comm node = comm_of(handle);
    if (ranks_max == INT_MAX)
        return node;
    MPI_Comm_split(handle, node.rank / ranks_max, node.rank, &part);
    MPI_Comm_free(&handle);
    return comm_of(part);
}

#ifdef HAVE_SIGBUS
static sigjmp_buf no_memory;

static void on_bus_error(int number)
{
    (void)number;
    siglongjmp(no_memory, 1);
}

/* True if the window's memory is there. */
static bool can_touch(char *data, size_t bytes)
{
    struct sigaction action, before;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_bus_error;
    sigaction(SIGBUS, &action, &before);
    volatile bool good = false;
    if (sigsetjmp(no_memory, 1) == 0) {
        memset(data, 0, bytes);
        good = true;
    }
    sigaction(SIGBUS, &before, NULL);
    return good;
}
#else
static bool can_touch(char *data, size_t bytes)
{
    memset(data, 0, bytes);
    return true;
}
#endif

static void close_window(struct node_block *block)
{
    MPI_Win_unlock_all(block->window);
    MPI_Win_free(&block->window);
}

/* Collective over the node. False on all of its ranks if there is no window; a window of
 * only some ranks cannot be freed, and is lost. */
static bool open_window(struct node_block *block)
{
    const struct comm *node = &block->node;
    MPI_Aint size = node->rank == 0 ? (MPI_Aint)(block->bytes + PACK_ALIGNMENT) : 0;
    int unit = 1;
    MPI_Comm_set_errhandler(node->handle, MPI_ERRORS_RETURN);
    int code = MPI_Win_allocate_shared(size, unit, MPI_INFO_NULL, node->handle,
                                       &block->data, &block->window);
    MPI_Comm_set_errhandler(node->handle, MPI_ERRORS_ARE_FATAL);
    if (comm_largest(node, code != MPI_SUCCESS) > 0.0)
        return false;
    MPI_Win_lock_all(MPI_MODE_NOCHECK, block->window);
    MPI_Win_shared_query(block->window, 0, &size, &unit, &block->data);
    int gap = PACK_ALIGNMENT; /* all begin where rank 0 does; -1: nowhere */
    if (node->rank == 0)
        gap = can_touch(block->data, (size_t)size) ? gap_of(block->data) : -1;
    gap = -(int)comm_largest(node, -gap);
    if (gap < 0)
        close_window(block);
    else
        block->data += gap;
    return gap >= 0;
}

/* Collective. */
static void share(struct node_block *block, const struct comm *comm, int ranks_max)
{
    block->node = find_node(comm, ranks_max);
    block->shared = block->node.size > 1 && open_window(block);
    block->fills = block->node.rank == 0;
    if (!block->shared)
        MPI_Comm_free(&block->node.handle);
}

void node_block_create(struct node_block *block, const struct comm *comm, size_t bytes,
                       struct node_policy policy)
{
    *block = (struct node_block){.bytes = bytes};
    if (comm->size > 1 && policy.ranks_max > 1 && bytes >= policy.least_bytes)
        share(block, comm, policy.ranks_max);
    if (block->shared)
        return;
    block->memory = alloc_array(bytes + PACK_ALIGNMENT, 1);
    block->data = (char *)block->memory + gap_of(block->memory);
    block->fills = true;
}

/* Collective. Ranks that do not fill take part all the same: a communicator without them
 * would be one more blocking call. */
static void send_to_fillers(struct node_block *block, const struct comm *comm)
{
    char *scratch = block->fills ? NULL : alloc_array(SPREAD_CHUNK, 1);
    for (size_t at = 0; at < block->bytes; at += SPREAD_CHUNK) {
        size_t left = block->bytes - at;
        comm_broadcast(comm, block->fills ? block->data + at : scratch,
                       left < SPREAD_CHUNK ? left : SPREAD_CHUNK);
    }
    alloc_free(scratch);
}

void node_block_spread(struct node_block *block, const struct comm *comm)
{
    if (comm_largest(comm, comm->rank > 0 && block->fills) > 0.0)
        send_to_fillers(block, comm);
    if (!block->shared)
        return;
    MPI_Request request;
    MPI_Win_sync(block->window);
    MPI_Ibarrier(block->node.handle, &request);
    comm_wait(&request);
    MPI_Win_sync(block->window);
}

void node_block_destroy(struct node_block *block)
{
    if (block->shared) {
        close_window(block);
        MPI_Comm_free(&block->node.handle);
    }
    alloc_free(block->memory);
    *block = (struct node_block){.data = NULL};
}
