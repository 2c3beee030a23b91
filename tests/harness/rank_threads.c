/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/rank_threads.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a rank shows to the others between two barriers. */
typedef struct call {
    void *packet;
    size_t size;
    ranks_join *join; /* NULL: an exchange */
    int n;
    const ranks_message *sent;
} call;

typedef struct meeting {
    pthread_barrier_t barrier;
    int n;
    call *calls; /* [n] */
} meeting;

static const double *pretended = NULL;

typedef struct member {
    meeting *place;
    ranks table;
    rank_threads_counts counts;
    double busy; /* s, as it pretends */
    rank_threads_work *work;
    void *context;
    pthread_t thread;
} member;

static void insist(int holds, const char *what)
{
    if (holds) return;
    (void)fprintf(stderr, "ranks disagree: %s\n", what);
    abort();
}

static void wait_for_all(member *m)
{
    (void)pthread_barrier_wait(&m->place->barrier);
}

static void show(member *m, call own)
{
    m->place->calls[m->table.rank] = own;
    wait_for_all(m);
    if (pretended != NULL) m->busy += pretended[m->table.rank];
    for (int k = 0; k < m->place->n; k++) {
        insist(m->place->calls[k].join == own.join, "not all make the same call");
        insist(m->place->calls[k].size == own.size, "packets have different sizes");
    }
}

static void reduce(void *self, void *packet, size_t size, ranks_join *join)
{
    member *m = self;
    _Alignas(max_align_t) unsigned char joined[RANKS_PACKET_MOST];
    insist(size <= sizeof joined, "a packet is too large");
    show(m, (call){.packet = packet, .size = size, .join = join});
    memcpy(joined, packet, size);
    for (int k = 1; k < m->place->n; k++) join(joined, m->place->calls[(m->table.rank + k) % m->place->n].packet);
    wait_for_all(m);
    memcpy(packet, joined, size);
    m->counts.reductions++;
}

static const ranks_message *find_message(const call *from, int to)
{
    for (int k = 0; k < from->n; k++)
        if (from->sent[k].rank == to) return &from->sent[k];
    insist(0, "a message that is expected has not been sent");
    return NULL;
}

static void exchange(void *self, int n, const ranks_message *sent, const ranks_message *received)
{
    member *m = self;
    show(m, (call){.n = n, .sent = sent});
    for (int k = 0; k < n; k++) {
        const ranks_message *of = find_message(&m->place->calls[received[k].rank], m->table.rank);
        insist(of->size == received[k].size, "a message has another size than is expected");
        if (of->size > 0) memcpy(received[k].bytes, of->bytes, of->size);
    }
    wait_for_all(m);
    m->counts.exchanges++;
}

static double pretended_time(const void *self)
{
    return ((const member *)self)->busy;
}

void rank_threads_pretend(const double *seconds)
{
    pretended = seconds;
}

static void *run(void *argument)
{
    member *m = argument;
    m->work(&m->table, m->context);
    return NULL;
}

void rank_threads_run(int n, rank_threads_work *work, void *context)
{
    meeting place = {.n = n, .calls = calloc((size_t)n, sizeof *place.calls)};
    member *members = calloc((size_t)n, sizeof *members);
    insist(place.calls != NULL && members != NULL, "no memory");
    insist(pthread_barrier_init(&place.barrier, NULL, (unsigned)n) == 0, "no barrier");
    for (int k = 0; k < n; k++) {
        member *m = &members[k];
        *m = (member){.place = &place, .work = work, .context = context};
        m->table = (ranks){.self = m, .rank = k, .size = n, .reduce = reduce, .exchange = exchange};
        if (pretended != NULL) m->table.busy = pretended_time;
        insist(pthread_create(&m->thread, NULL, run, m) == 0, "no thread");
    }
    for (int k = 0; k < n; k++) (void)pthread_join(members[k].thread, NULL);
    (void)pthread_barrier_destroy(&place.barrier);
    free(members);
    free(place.calls);
}

rank_threads_counts rank_threads_count(const ranks *r)
{
    return ((const member *)r->self)->counts;
}
