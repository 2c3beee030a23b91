/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks: processes that share a model, each of which has the nodes of a domain, as one of them sees the others. All
 * that they say to each other is said through this table of functions. These are *collective*: every rank calls the
 * same ones in the same order, and each waits for what it needs of the others. A process alone has a table of its
 * own. */
#ifndef DEM_BASE_RANKS_H
#define DEM_BASE_RANKS_H

#include <signal.h>
#include <stddef.h>

/** Joins a packet to another one of the same kind: commutative and associative to the bit, so that no order of ranks
 *  has a part in the result. */
typedef void ranks_join(void *packet, const void *other);

/** What goes to one rank, or comes from it. */
typedef struct ranks_message {
    int rank;
    size_t size; /* bytes */
    void *bytes; /* [size] */
} ranks_message;

/** What may be asked of a run from outside: its end, and a checkpoint. */
enum { RANKS_REQUESTS = 2 };

typedef struct ranks {
    void *self;     /* what the functions work on */
    int rank, size; /* this one, 0 <= rank < size, and how many there are */
    /** Joins the packets of all ranks: each gets the result in its packet, at most RANKS_PACKET_MOST bytes. */
    void (*reduce)(void *self, void *packet, size_t size, ranks_join *join);
    /** Sends n messages and receives as many, one to and one from each of n other ranks, in ascending order. */
    void (*exchange)(void *self, int n, const ranks_message *sent, const ranks_message *received);
    /** Processor time of the calling thread outside of the functions above, s, since some time in the past. NULL: not
     *  known. */
    double (*busy)(const void *self);
    /** Frees the table, of which nothing is used afterwards. NULL where nobody but its maker ends it. */
    void (*end)(void *self);
    /** Numbers in which signal handlers of this rank note what is asked; 0: nothing. What another rank has there rank 0
     *  gets by the next call that it makes on all (simulation/rank_call.h). NULL where nobody asks. */
    volatile sig_atomic_t *requests[RANKS_REQUESTS];
    /** Ends all ranks of a program where this one is out of memory, dem_status_message() saying for what: it could not
     *  report that to others, which wait for something else. NULL: the program sees to it (dem/mpi.h). */
    void (*lacks_memory)(void *program);
    void *program;
} ranks;

enum { RANKS_PACKET_MOST = 8192 };

/** Of a process alone. */
extern const ranks ranks_alone;

/** What `busy` says, s; 0: nobody knows. */
static inline double ranks_busy(const ranks *r)
{
    return r->busy != NULL ? r->busy(r->self) : 0.0;
}

#endif
