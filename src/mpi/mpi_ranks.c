/* SPDX-License-Identifier: BSD-3-Clause */
/* What ranks say to each other, by MPI 3.1. A packet is one item of a type of its size, so that MPI never takes it
 * apart, and is joined by one operation for all kinds of packets. MPI hands no context to an operation: which join it
 * stands for is noted for the thread that reduces, in which MPI calls it. */
#include "mpi/mpi_ranks.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Lengths of messages are of type int: a longer one goes in pieces. */
enum { MESSAGE_MOST = 1 << 30 };

typedef struct mpi_ranks {
    ranks table;
    MPI_Comm communicator;
    MPI_Op op;
    MPI_Datatype packets[RANKS_PACKET_MOST + 1]; /* by size, made when they are needed */
    MPI_Request *requests;                       /* [2 size] */
    double waited;                               /* s of processor time in MPI, as ranks wait without sleeping */
} mpi_ranks;

/* ---- time ---- */

/* Of this thread, s. */
static double processor_time(void)
{
    struct timespec t;
    return clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) == 0 ? (double)t.tv_sec + 1e-9 * (double)t.tv_nsec : 0.0;
}

static double busy(const void *self)
{
    return processor_time() - ((const mpi_ranks *)self)->waited;
}

/* 0 where nobody asks how long ranks are busy: two looks at this clock take as long as a short message. */
static double now(const mpi_ranks *m)
{
    return m->table.busy != NULL ? processor_time() : 0.0;
}

/* ---- reductions ---- */

static _Thread_local struct {
    ranks_join *join;
    size_t size;
} current;

/* The packets that MPI hands over may begin anywhere. */
static void join_packets(void *in, void *inout, int *n, MPI_Datatype *type)
{
    _Alignas(max_align_t) unsigned char own[RANKS_PACKET_MOST], other[RANKS_PACKET_MOST];
    (void)type;
    for (int k = 0; k < *n; k++) {
        const size_t at = (size_t)k * current.size;
        memcpy(own, (char *)inout + at, current.size);
        memcpy(other, (const char *)in + at, current.size);
        current.join(own, other);
        memcpy((char *)inout + at, own, current.size);
    }
}

static MPI_Datatype packet_of(mpi_ranks *m, size_t size)
{
    MPI_Datatype *type = &m->packets[size];
    if (*type == MPI_DATATYPE_NULL) {
        (void)MPI_Type_contiguous((int)size, MPI_BYTE, type);
        (void)MPI_Type_commit(type);
    }
    return *type;
}

static void reduce(void *self, void *packet, size_t size, ranks_join *join)
{
    mpi_ranks *m = self;
    current.join = join;
    current.size = size;
    const double begin = now(m);
    (void)MPI_Allreduce(MPI_IN_PLACE, packet, 1, packet_of(m, size), m->op, m->communicator);
    m->waited += now(m) - begin;
}

/* ---- messages ---- */

/* The length of a message's piece that begins at `from`; 0: there is none. */
static int piece_of(const ranks_message *m, size_t from)
{
    const size_t left = m->size > from ? m->size - from : 0;
    return left > MESSAGE_MOST ? MESSAGE_MOST : (int)left;
}

/* Messages between two ranks come in the order in which they are sent. */
static void exchange(void *self, int n, const ranks_message *sent, const ranks_message *received)
{
    mpi_ranks *m = self;
    const double begin = now(m);
    int n_requests = 1;
    for (size_t from = 0; n_requests > 0; from += MESSAGE_MOST) {
        n_requests = 0;
        for (int k = 0; k < n; k++)
            if (piece_of(&received[k], from) > 0)
                (void)MPI_Irecv((char *)received[k].bytes + from, piece_of(&received[k], from), MPI_BYTE,
                                received[k].rank, 0, m->communicator, &m->requests[n_requests++]);
        for (int k = 0; k < n; k++)
            if (piece_of(&sent[k], from) > 0)
                (void)MPI_Isend((const char *)sent[k].bytes + from, piece_of(&sent[k], from), MPI_BYTE, sent[k].rank, 0,
                                m->communicator, &m->requests[n_requests++]);
        (void)MPI_Waitall(n_requests, m->requests, MPI_STATUSES_IGNORE);
    }
    m->waited += now(m) - begin;
}

/* ---- begin and end ---- */

static void end(void *self)
{
    mpi_ranks *m = self;
    int is_finalised = 0;
    (void)MPI_Finalized(&is_finalised);
    for (int k = 0; k <= RANKS_PACKET_MOST && !is_finalised; k++)
        if (m->packets[k] != MPI_DATATYPE_NULL) (void)MPI_Type_free(&m->packets[k]);
    if (!is_finalised) {
        (void)MPI_Op_free(&m->op);
        (void)MPI_Comm_free(&m->communicator);
    }
    free(m->requests);
    free(m);
}

static bool have_all(MPI_Comm communicator, bool own)
{
    int all = own;
    (void)MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, communicator);
    return all != 0;
}

/* The functions of the table return nothing: a failure inside MPI has to end the program. */
static void begin(mpi_ranks *m, MPI_Comm communicator)
{
    (void)MPI_Comm_dup(communicator, &m->communicator);
    (void)MPI_Comm_set_errhandler(m->communicator, MPI_ERRORS_ARE_FATAL);
    (void)MPI_Op_create(join_packets, 1, &m->op);
    for (int k = 0; k <= RANKS_PACKET_MOST; k++) m->packets[k] = MPI_DATATYPE_NULL;
}

ranks *mpi_ranks_create(MPI_Comm communicator)
{
    int rank, size;
    (void)MPI_Comm_rank(communicator, &rank);
    (void)MPI_Comm_size(communicator, &size);
    mpi_ranks *m = calloc(1, sizeof *m);
    MPI_Request *requests = calloc(2 * (size_t)size, sizeof *requests);
    if (!have_all(communicator, m != NULL && requests != NULL)) {
        free(m);
        free(requests);
        return NULL;
    }
    m->table = (ranks){.self = m, .rank = rank, .size = size, .reduce = reduce, .exchange = exchange, .end = end};
    m->requests = requests;
    begin(m, communicator);
    return &m->table;
}

void mpi_ranks_measure(ranks *r)
{
    r->busy = busy;
}
