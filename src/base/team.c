/* SPDX-License-Identifier: BSD-3-Clause */
/* Each thread has a range of the shares of a loop, the same part of the body every time, which its caches have. It
 * claims them from the front, and then those of others from the back, each by one compare-and-swap of the range. What a
 * claim returns is a share of the loop that is under way, however late its thread has come: a loop ends only when all
 * claimed shares are done, and then no range has any left.
 *
 * A helper without work looks for more during `linger`, then sleeps. To wake it costs the caller some time, more if the
 * helper takes its core; if the system takes a helper's core away in the middle of a share, the caller has to wait; and
 * two cores may share what binds. So now and then the caller takes short loops alone, by whose time each later one of
 * that kind is judged. A trial of a long loop would cost much: it is judged by the time of the shares that helpers have
 * done. If a loss remains, of which gains of before are taken off up to a limit, the caller works alone for a multiple
 * of it: so threads cost a few per cent at most where they do not pay.
 *
 * Threads sleep on semaphores, as these need no lock that a fork could leave held. */
#include "base/team.h"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "base/aligned.h"
#include "base/cores.h"

enum {
    SHARES_OF_THREAD = 4,      /* at most */
    LINGER = 20000,            /* ns that a helper looks for work: about what it takes to wake one */
    LOOKS = 32,                /* between two looks at the clock */
    TOLERATED = 200000,        /* ns that may be lost before the caller works alone, */
    ALONE = 32,                /* for this multiple of what is lost */
    KEPT = 2000000,            /* ns of gains, at most, that later losses are set against */
    TRIAL = 500000,            /* ns for which the caller takes loops alone to learn how long they take, */
    BETWEEN_TRIALS = 50000000, /* ns */
    SHORT = 100000,            /* ns of a loop that takes part in them */
    KINDS = 8                  /* of loops that are remembered */
};

/* Loops of one kind: the work, and into how many shares it is divided. */
typedef struct loop_kind {
    team_work *work;
    int n_shares;
    int64_t alone;    /* ns that one takes the caller alone, in the mean of trials; 0: not known */
    int64_t estimate; /* ns that the last one would have taken it, by the time of its shares; 0: not known */
} loop_kind;

/* A thread that waits for another's signal. */
typedef struct waiter {
    atomic_bool waiting; /* or about to be; who clears this wakes it */
    sem_t signal;
} waiter;

/* One thread; the first is the caller. */
typedef struct member {
    _Alignas(ALIGNED_TO) _Atomic uint64_t range; /* of shares that nobody has claimed: (first, behind the last) */
    waiter waiter;
    pthread_t thread;
    struct team *team;
    int number;
} member;

struct team {
    member *members; /* [most] */
    int most;
    int n_threads; /* of the members, those that are threads */
    dem_index least;
    int64_t linger;  /* ns */
    pid_t process;   /* which has the helpers */
    team_work *work; /* of the loop under way, for who has claimed a share */
    const void *context;
    loop_kind kinds[KINDS];
    int next_kind;       /* which is forgotten for a new one */
    int64_t lost;        /* ns, and not made up for yet; < 0: gained */
    int64_t alone_until; /* ns, as the next is */
    int64_t trial;       /* when the next begins, or began that is under way */
    atomic_flag at_work;
    _Alignas(ALIGNED_TO) atomic_uint loops; /* begun so far */
    atomic_bool ended;
    _Alignas(ALIGNED_TO) atomic_int left; /* shares that are not done */
};

static int64_t now(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Leaves the core to the other thread that may share it. */
static void relax(void)
{
#ifdef DEM_X86_KERNELS
    __builtin_ia32_pause();
#endif
}

/* ---- waiting ---- */

static void announce_wait(waiter *w)
{
    atomic_store(&w->waiting, true);
}

/* After announce_wait() and a look that there is something to wait for. What interrupts the program does not end it. */
static void wait_for_signal(waiter *w)
{
    while (sem_wait(&w->signal) != 0) continue;
}

/* After announce_wait(), when there is nothing to wait for: a signal that is under way is received. */
static void cancel_wait(waiter *w)
{
    if (!atomic_exchange(&w->waiting, false)) wait_for_signal(w);
}

static void send_signal(waiter *w)
{
    if (atomic_load(&w->waiting) && atomic_exchange(&w->waiting, false)) (void)sem_post(&w->signal);
}

/* ---- shares ---- */

static uint64_t range_of(uint32_t first, uint32_t end)
{
    return (uint64_t)first << 32 | end;
}

/* A share of a range, or -1 if there is none left. */
static int claim(_Atomic uint64_t *range, bool from_front)
{
    uint64_t seen = atomic_load(range);
    for (;;) {
        const uint32_t first = (uint32_t)(seen >> 32), end = (uint32_t)seen;
        if (first == end) return -1;
        const uint64_t rest = from_front ? range_of(first + 1, end) : range_of(first, end - 1);
        if (atomic_compare_exchange_weak(range, &seen, rest)) return (int)(from_front ? first : end - 1);
    }
}

/* Does shares of a range as long as there are any.  \return how many */
static int work_through(team *t, int range, int thread)
{
    int n = 0;
    for (int share; (share = claim(&t->members[range].range, range == thread)) >= 0; n++)
        t->work(t->context, share, thread);
    return n;
}

/* All that can be claimed, one's own first.  \return how many */
static int work_through_all(team *t, int thread)
{
    int n = 0;
    for (int k = 0; k < t->most; k++) n += work_through(t, (thread + k) % t->most, thread);
    return n;
}

/* Shares that a thread has claimed are done.  \return whether all are */
static bool settle(team *t, int n)
{
    return atomic_fetch_sub(&t->left, n) == n;
}

/* ---- helpers ---- */

/* Returns when another loop than number `seen` has begun, or the team ends. */
static void wait_for_loop(member *m, unsigned seen)
{
    team *t = m->team;
    const int64_t end = now() + t->linger;
    do
        for (int k = 0; k < LOOKS; k++, relax())
            if (atomic_load(&t->loops) != seen) return;
    while (now() < end);
    announce_wait(&m->waiter);
    if (atomic_load(&t->loops) != seen)
        cancel_wait(&m->waiter);
    else
        wait_for_signal(&m->waiter);
}

static void *help(void *self)
{
    member *m = self;
    team *t = m->team;
    for (;;) {
        const unsigned seen = atomic_load(&t->loops);
        if (atomic_load(&t->ended)) return NULL;
        const int n = work_through_all(t, m->number);
        if (n > 0 && settle(t, n)) send_signal(&t->members[0].waiter);
        wait_for_loop(m, seen);
    }
}

/* ---- the caller ---- */

/* Tells helpers, the first n - 1, that there is something new. */
static void call(team *t, int n)
{
    (void)atomic_fetch_add(&t->loops, 1);
    for (int k = 1; k < n; k++) send_signal(&t->members[k].waiter);
}

/* A helper that has cleared `waiting` late, for a loop that has ended since, wakes the caller too early. */
static void wait_until_done(team *t)
{
    waiter *s = &t->members[0].waiter;
    while (atomic_load(&t->left) > 0) {
        announce_wait(s);
        if (atomic_load(&t->left) > 0)
            wait_for_signal(s);
        else
            cancel_wait(s);
    }
}

/* Waits for shares that helpers have claimed.
 * \param share  ns that one has taken */
static void wait_for_helpers(team *t, int64_t share)
{
    const int64_t patience = now() + 2 * share + t->linger;
    do
        for (int k = 0; k < LOOKS; k++, relax())
            if (atomic_load(&t->left) == 0) return;
    while (now() < patience);
    wait_until_done(t);
}

/* ---- what pays ---- */

/* What is remembered of loops of a kind; a new one takes the place of another. */
static loop_kind *kind_of(team *t, int n_shares, team_work *work)
{
    for (int k = 0; k < KINDS; k++)
        if (t->kinds[k].work == work && t->kinds[k].n_shares == n_shares) return &t->kinds[k];
    loop_kind *kind = &t->kinds[t->next_kind];
    t->next_kind = (t->next_kind + 1) % KINDS;
    *kind = (loop_kind){.work = work, .n_shares = n_shares};
    return kind;
}

/* Loops of a kind may differ, so that their mean counts; of one in which the system has taken the core away, little. */
static void learn(loop_kind *kind, int64_t duration)
{
    const int64_t most = 4 * kind->alone, counted = duration < most ? duration : most;
    kind->alone = kind->alone == 0 ? duration : kind->alone + (counted - kind->alone) / 8;
}

static bool is_short(const loop_kind *kind)
{
    return kind->estimate > 0 && kind->estimate < SHORT;
}

/* Whether a loop that begins now is the caller's alone. A trial is for short loops. */
static bool takes_alone(team *t, const loop_kind *kind, int64_t begin)
{
    if (begin < t->alone_until) return true;
    if (begin > t->trial + TRIAL) t->trial = begin + BETWEEN_TRIALS;
    return begin >= t->trial && is_short(kind);
}

/* Sets what a loop has lost, ns, or gained, against what was before. */
static void weigh(team *t, int64_t loss)
{
    t->lost = t->lost + loss > -KEPT ? t->lost + loss : -KEPT;
    if (t->lost <= TOLERATED) return;
    t->alone_until = now() + ALONE * t->lost;
    t->lost = 0;
}

/* ---- loops ---- */

static void run_alone(int n_shares, team_work *work, const void *context)
{
    for (int share = 0; share < n_shares; share++) work(context, share, 0);
}

/* \return ns that it would have taken the caller alone, as far as its own shares tell */
static int64_t run_together(team *t, int n_shares, team_work *work, const void *context)
{
    const int n = n_shares < t->n_threads ? n_shares : t->n_threads;
    t->work = work;
    t->context = context;
    atomic_store(&t->left, n_shares);
    for (int k = 0; k < n; k++)
        atomic_store(&t->members[k].range,
                     range_of((uint32_t)team_share(n_shares, n, k), (uint32_t)team_share(n_shares, n, k + 1)));
    call(t, n);
    const int64_t called = now();
    const int own = work_through_all(t, 0);
    const int64_t share = (now() - called) / (own > 0 ? own : 1);
    if (!settle(t, own)) wait_for_helpers(t, share);
    return share * n_shares;
}

void team_run(team *t, int n_shares, team_work *work, const void *context)
{
    if (t == NULL || n_shares == 1 || atomic_flag_test_and_set(&t->at_work)) {
        run_alone(n_shares, work, context);
        return;
    }
    loop_kind *kind = kind_of(t, n_shares, work);
    const int64_t begin = now();
    if (takes_alone(t, kind, begin)) {
        run_alone(n_shares, work, context);
        learn(kind, now() - begin);
    } else {
        kind->estimate = run_together(t, n_shares, work, context);
        weigh(t, now() - begin - (kind->alone > 0 && is_short(kind) ? kind->alone : kind->estimate));
    }
    atomic_flag_clear(&t->at_work);
}

int team_threads(const team *t)
{
    return t != NULL ? t->n_threads : 1;
}

int team_shares(const team *t, dem_index nodes)
{
    if (t == NULL || nodes < 2 * t->least) return 1;
    const dem_index n = nodes / t->least, threads = t->n_threads, most = SHARES_OF_THREAD * threads;
    return (int)(n < threads ? n : n < most ? n - n % threads : most);
}

/* ---- making and ending ---- */

/* Helpers that cannot be created are left out. Signals are for the threads of the program. */
static void create_helpers(team *t)
{
    sigset_t all, before;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    for (t->n_threads = 1; t->n_threads < t->most; t->n_threads++) {
        member *m = &t->members[t->n_threads];
        if (pthread_create(&m->thread, NULL, help, m) != 0) break;
    }
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
}

static void free_team(team *t)
{
    free(t->members);
    free(t);
}

/* Zeros at a cache line. The sizes of what is aligned to that are multiples of it. */
static void *zeroed(size_t bytes)
{
    return aligned_zeros(bytes / sizeof(double));
}

team *team_create(int most, dem_index least)
{
    if (most < 2) return NULL;
    team *t = zeroed(sizeof *t);
    if (t == NULL) return NULL;
    t->members = zeroed((size_t)most * sizeof *t->members);
    t->most = t->members != NULL ? most : 0;
    t->least = least;
    t->linger = most <= cores_allowed() ? LINGER : 0;
    t->process = getpid();
    atomic_flag_clear(&t->at_work);
    for (int k = 0; k < t->most; k++) {
        t->members[k].team = t;
        t->members[k].number = k;
        (void)sem_init(&t->members[k].waiter.signal, 0, 0);
    }
    create_helpers(t);
    if (t->n_threads > 1) return t;
    free_team(t);
    return NULL;
}

void team_destroy(team *t)
{
    if (t == NULL) return;
    if (t->process == getpid()) {
        atomic_store(&t->ended, true);
        call(t, t->n_threads);
        for (int k = 1; k < t->n_threads; k++) (void)pthread_join(t->members[k].thread, NULL);
        for (int k = 0; k < t->most; k++) (void)sem_destroy(&t->members[k].waiter.signal);
    }
    free_team(t);
}
