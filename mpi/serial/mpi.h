/* A stand-in for MPI with one process, for `make SERIAL=1`: the calls that phr uses, each
 * doing what MPI does in a communicator of size 1. A datatype is its size in bytes. */
#ifndef MPI_SERIAL_MPI_H
#define MPI_SERIAL_MPI_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef int MPI_Comm;
typedef int MPI_Request;
typedef int MPI_Datatype;
typedef int MPI_Op;
typedef int MPI_Win;
typedef int MPI_Info;
typedef int MPI_Errhandler;
typedef ptrdiff_t MPI_Aint;

enum { MPI_SUCCESS = 0, MPI_COMM_WORLD = 0, MPI_COMM_SELF = 1, MPI_REQUEST_NULL = 0 };
enum { MPI_SUM, MPI_MAX };
enum {
    MPI_INFO_NULL,
    MPI_ERRORS_RETURN,
    MPI_ERRORS_ARE_FATAL,
    MPI_COMM_TYPE_SHARED,
    MPI_MODE_NOCHECK
};

#define MPI_STATUS_IGNORE NULL
#define MPI_IN_PLACE ((void *)-1)
#define MPI_BYTE 1
#define MPI_INT ((MPI_Datatype)sizeof(int))
#define MPI_INT64_T 8
#define MPI_UINT8_T 1
#define MPI_DOUBLE 8
#define MPI_FLOAT 4
#define MPI_MAX_PROCESSOR_NAME 16

static inline void serial_copy(const void *from, void *to, int count, MPI_Datatype type)
{
    if (from != MPI_IN_PLACE && count > 0)
        memcpy(to, from, (size_t)count * (size_t)type);
}

static inline int MPI_Init(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    return MPI_SUCCESS;
}

static inline int MPI_Initialized(int *flag)
{
    *flag = 0;
    return MPI_SUCCESS;
}

static inline int MPI_Finalize(void)
{
    return MPI_SUCCESS;
}

static inline int MPI_Abort(MPI_Comm comm, int code)
{
    (void)comm;
    exit(code);
}

static inline int MPI_Get_processor_name(char *name, int *length)
{
    strcpy(name, "this");
    *length = 4;
    return MPI_SUCCESS;
}

static inline double MPI_Wtime(void)
{
    return (double)clock() /
           (double)CLOCKS_PER_SEC; /* C99 has no better: processor time */
}

static inline int MPI_Comm_idup(MPI_Comm comm, MPI_Comm *copy, MPI_Request *request)
{
    *copy = comm;
    *request = MPI_REQUEST_NULL;
    return MPI_SUCCESS;
}

static inline int MPI_Comm_split(MPI_Comm comm, int colour, int key, MPI_Comm *part)
{
    (void)colour;
    (void)key;
    *part = comm;
    return MPI_SUCCESS;
}

static inline int MPI_Comm_split_type(MPI_Comm comm, int type, int key, MPI_Info info,
                                      MPI_Comm *part)
{
    (void)info;
    return MPI_Comm_split(comm, type, key, part);
}

static inline int MPI_Comm_set_errhandler(MPI_Comm comm, MPI_Errhandler handler)
{
    (void)comm;
    (void)handler;
    return MPI_SUCCESS;
}

static inline int MPI_Comm_free(MPI_Comm *comm)
{
    *comm = -1;
    return MPI_SUCCESS;
}

static inline int MPI_Comm_rank(MPI_Comm comm, int *rank)
{
    (void)comm;
    *rank = 0;
    return MPI_SUCCESS;
}

static inline int MPI_Comm_size(MPI_Comm comm, int *size)
{
    (void)comm;
    *size = 1;
    return MPI_SUCCESS;
}

static inline int MPI_Test(MPI_Request *request, int *done, void *status)
{
    (void)status;
    *request = MPI_REQUEST_NULL;
    *done = 1;
    return MPI_SUCCESS;
}

static inline int MPI_Type_contiguous(int count, MPI_Datatype old, MPI_Datatype *made)
{
    *made = count * old;
    return MPI_SUCCESS;
}

static inline int MPI_Type_commit(MPI_Datatype *type)
{
    (void)type;
    return MPI_SUCCESS;
}

static inline int MPI_Type_free(MPI_Datatype *type)
{
    *type = 0;
    return MPI_SUCCESS;
}

static inline int MPI_Ibarrier(MPI_Comm comm, MPI_Request *request)
{
    (void)comm;
    *request = MPI_REQUEST_NULL;
    return MPI_SUCCESS;
}

/* One process has nobody to send to. */
static inline int MPI_Isend(const void *buffer, int count, MPI_Datatype type, int to,
                            int tag, MPI_Comm comm, MPI_Request *request)
{
    (void)buffer;
    (void)count;
    (void)type;
    (void)to;
    (void)tag;
    (void)request;
    return MPI_Abort(comm, 1);
}

static inline int MPI_Irecv(void *buffer, int count, MPI_Datatype type, int from, int tag,
                            MPI_Comm comm, MPI_Request *request)
{
    return MPI_Isend(buffer, count, type, from, tag, comm, request);
}

/* Nor anybody to share memory with. */
static inline int MPI_Win_allocate_shared(MPI_Aint size, int unit, MPI_Info info,
                                          MPI_Comm comm, void *base, MPI_Win *window)
{
    (void)size;
    (void)unit;
    (void)info;
    (void)base;
    (void)window;
    return MPI_Abort(comm, 1);
}

static inline int MPI_Win_shared_query(MPI_Win window, int rank, MPI_Aint *size,
                                       int *unit, void *base)
{
    (void)rank;
    return MPI_Win_allocate_shared(*size, *unit, MPI_INFO_NULL, MPI_COMM_WORLD, base,
                                   &window);
}

static inline int MPI_Win_lock_all(int mode, MPI_Win window)
{
    (void)mode;
    (void)window;
    return MPI_Abort(MPI_COMM_WORLD, 1);
}

static inline int MPI_Win_sync(MPI_Win window)
{
    return MPI_Win_lock_all(0, window);
}

static inline int MPI_Win_unlock_all(MPI_Win window)
{
    return MPI_Win_lock_all(0, window);
}

static inline int MPI_Win_free(MPI_Win *window)
{
    return MPI_Win_lock_all(0, *window);
}

static inline int MPI_Ibcast(void *buffer, int count, MPI_Datatype type, int root,
                             MPI_Comm comm, MPI_Request *request)
{
    (void)buffer;
    (void)count;
    (void)type;
    (void)root;
    return MPI_Ibarrier(comm, request);
}

static inline int MPI_Iallreduce(const void *send, void *receive, int count,
                                 MPI_Datatype type, MPI_Op op, MPI_Comm comm,
                                 MPI_Request *request)
{
    (void)op;
    serial_copy(send, receive, count, type);
    return MPI_Ibarrier(comm, request);
}

static inline int MPI_Iallgather(const void *send, int count, MPI_Datatype type,
                                 void *receive, int receive_count,
                                 MPI_Datatype receive_type, MPI_Comm comm,
                                 MPI_Request *request)
{
    (void)receive_count;
    (void)receive_type;
    serial_copy(send, receive, count, type);
    return MPI_Ibarrier(comm, request);
}

static inline int MPI_Iallgatherv(const void *send, int count, MPI_Datatype type,
                                  void *receive, const int *counts,
                                  const int *displacements, MPI_Datatype receive_type,
                                  MPI_Comm comm, MPI_Request *request)
{
    (void)counts;
    (void)displacements;
    (void)receive_type;
    serial_copy(send, receive, count, type);
    return MPI_Ibarrier(comm, request);
}

static inline int MPI_Ialltoall(const void *send, int count, MPI_Datatype type,
                                void *receive, int receive_count,
                                MPI_Datatype receive_type, MPI_Comm comm,
                                MPI_Request *request)
{
    return MPI_Iallgather(send, count, type, receive, receive_count, receive_type, comm,
                          request);
}

#endif
