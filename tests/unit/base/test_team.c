/* SPDX-License-Identifier: BSD-3-Clause */
/* team.c: each share is done once, by whom ever; helpers come, go and fail to be created. */
#include "unit/free_team.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "harness/test.h"

/* How many threads may be created from here on. */
static atomic_int n_allowed = 1000;

typedef void *start_function(void *);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, start_function *start, void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, start_function *start, void *argument);

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, start_function *start, void *argument)
{
    return n_allowed-- > 0 ? __real_pthread_create(thread, attributes, start, argument) : EAGAIN;
}

enum { MOST = 40, MOST_THREADS = 8 };

/* What the shares of loops leave: plain numbers, so that a race among them is one. */
typedef struct record {
    long done[MOST];            /* by share */
    long scratch[MOST_THREADS]; /* by thread */
    int thread[MOST];           /* that has done the share last */
    atomic_bool begun[MOST];    /* by share */
    team *inner;                /* whose loop a share runs */
    int late[2];                /* ms that a share takes in the caller, and in a helper */
    atomic_int n_at_work;       /* threads */
} record;

static int64_t nanoseconds(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static void pause_for(int milliseconds)
{
    if (milliseconds > 0) (void)nanosleep(&(struct timespec){.tv_nsec = milliseconds * 1000000L}, NULL);
}

static void count(const void *context, int share, int thread)
{
    record *r = *(record *const *)context;
    r->done[share]++;
    r->scratch[thread]++;
    r->thread[share] = thread;
    pause_for(r->late[thread > 0]);
}

/* Whether a share is begun within ten seconds. */
static bool begins(record *r, int share)
{
    for (int k = 0; k < 10000 && !r->begun[share]; k++) pause_for(1);
    return r->begun[share];
}

/* Share 0 lasts until share 1 has begun, and the other way round. */
static void meet(const void *context, int share, int thread)
{
    record *r = *(record *const *)context;
    r->begun[share] = true;
    const bool both = begins(r, 1 - share);
    pause_for(r->late[thread > 0]);
    r->done[share] += both;
    r->thread[share] = thread;
}

static void run(team *t, int n_shares, team_work *work, record *r)
{
    team_run(t, n_shares, work, &r);
}

TEST(each_share_is_done_once)
{
    for (int n_threads = 1; n_threads <= 4; n_threads++) {
        CLEANUP(free_team) team *t = team_create(n_threads, 1);
        assert_int_equal(team_threads(t), n_threads);
        for (int n_shares = 0; n_shares <= MOST; n_shares++) {
            record r = {0};
            long done = 0;
            for (int loop = 0; loop < 200; loop++) run(t, n_shares, count, &r);
            for (int k = 0; k < MOST; k++) assert_int_equal(r.done[k], k < n_shares ? 200 : 0);
            for (int k = 0; k < n_threads; k++) done += r.scratch[k];
            assert_int_equal(done, 200 * n_shares);
        }
    }
}

TEST(a_helper_takes_what_the_caller_has_not_begun)
{
    for (int delay = 0; delay < 20; delay += 5) { /* it looks for work, or has gone to sleep */
        CLEANUP(free_team) team *t = team_create(2, 1);
        record r = {.late = {0, delay}};
        pause_for(delay);
        run(t, 2, meet, &r);
        assert_int_equal(r.done[0] + r.done[1], 2);
        assert_int_equal(r.thread[0] + r.thread[1], 1);
    }
}

TEST(after_a_delay_the_caller_works_alone)
{
    CLEANUP(free_team) team *t = team_create(2, 1);
    record late = {.late = {0, 300}}, slow = {.late = {1, 1}};
    run(t, 2, meet, &late);
    run(t, MOST, count, &slow);
    assert_int_equal(slow.scratch[0], MOST);
    assert_int_equal(slow.scratch[1], 0);
}

/* A share that takes the processor 2 us, and 16 us where another thread works at one, too. */
static void hinder(const void *context, int share, int thread)
{
    record *r = *(record *const *)context;
    const bool alone = atomic_fetch_add(&r->n_at_work, 1) == 0;
    const int64_t end = nanoseconds() + 2000;
    bool hindered = !alone;
    while (nanoseconds() < end + (hindered ? 14000 : 0)) hindered = hindered || r->n_at_work > 1;
    (void)atomic_fetch_sub(&r->n_at_work, 1);
    r->scratch[thread]++;
    (void)share;
}

/* For a second of them: the caller's own shares tell of a gain by helpers that is a loss. */
TEST(where_threads_hinder_each_other_the_caller_works_alone)
{
    CLEANUP(free_team) team *t = team_create(2, 1);
    record r = {0};
    long loops = 0;
    for (const int64_t end = nanoseconds() + 1000000000; nanoseconds() < end; loops++) run(t, 4, hinder, &r);
    assert_true(loops > 0);
    assert_true(r.scratch[1] < loops / 4);
}

static void run_inner(const void *context, int share, int thread)
{
    record *r = *(record *const *)context;
    record own = {0};
    (void)thread;
    run(r->inner, MOST, count, &own);
    for (int k = 0; k < MOST; k++) r->done[share] += own.thread[k] == 0 && own.done[k] == 1;
}

TEST(a_loop_within_a_share_is_done_by_its_thread)
{
    CLEANUP(free_team) team *t = team_create(3, 1);
    for (int loop = 0; loop < 100; loop++) {
        record r = {.inner = t};
        run(t, 4, run_inner, &r);
        for (int k = 0; k < 4; k++) assert_int_equal(r.done[k], MOST);
    }
}

/* Loops in a thread of the program, of a team that is its own or another's, too. */
typedef struct user {
    team *team;
    pthread_t thread;
    int n_wrong;
} user;

static void *use(void *self)
{
    user *u = self;
    team *own = u->team == NULL ? team_create(2, 1) : NULL;
    for (int loop = 0; loop < 500; loop++) {
        record r = {0};
        run(own != NULL ? own : u->team, MOST, count, &r);
        for (int k = 0; k < MOST; k++) u->n_wrong += r.done[k] != 1;
    }
    team_destroy(own);
    return NULL;
}

static void use_in_two_threads(team *t)
{
    user users[2] = {{.team = t}, {.team = t}};
    for (int k = 0; k < 2; k++) assert_int_equal(pthread_create(&users[k].thread, NULL, use, &users[k]), 0);
    for (int k = 0; k < 2; k++) assert_int_equal(pthread_join(users[k].thread, NULL), 0);
    assert_int_equal(users[0].n_wrong + users[1].n_wrong, 0);
}

TEST(teams_in_several_threads_know_nothing_of_each_other)
{
    use_in_two_threads(NULL);
}

TEST(a_team_that_is_at_work_leaves_a_loop_to_its_caller)
{
    CLEANUP(free_team) team *t = team_create(2, 1);
    use_in_two_threads(t);
}

TEST(what_cannot_be_created_is_done_without)
{
    record r = {0};
    for (int n = 0; n <= 3; n++) {
        n_allowed = n;
        CLEANUP(free_team) team *t = team_create(4, 1);
        n_allowed = 1000;
        assert_int_equal(team_threads(t), n + 1);
        assert_true((t == NULL) == (n == 0));
        run(t, MOST, count, &r);
        for (int k = 0; k < MOST; k++) assert_int_equal(r.done[k], n + 1);
    }
}

static int threads_of_process(void)
{
    DIR *tasks = opendir("/proc/self/task");
    int n = 0;
    while (readdir(tasks) != NULL) n++;
    (void)closedir(tasks);
    return n;
}

TEST(helpers_end_with_their_team)
{
    const int before = threads_of_process();
    team *t = team_create(4, 1);
    assert_int_equal(threads_of_process(), before + 3);
    team_destroy(t);
    assert_int_equal(threads_of_process(), before);
}

static void look_at_signals(const void *context, int share, int thread)
{
    record *r = *(record *const *)context;
    sigset_t blocked;
    meet(context, share, thread);
    (void)pthread_sigmask(SIG_SETMASK, NULL, &blocked);
    r->done[share] = sigismember(&blocked, SIGTERM);
}

TEST(signals_are_for_the_threads_of_the_program)
{
    CLEANUP(free_team) team *t = team_create(2, 1);
    record r = {0};
    run(t, 2, look_at_signals, &r);
    for (int k = 0; k < 2; k++) assert_int_equal(r.done[k], r.thread[k]);
    sigset_t blocked;
    assert_int_equal(pthread_sigmask(SIG_SETMASK, NULL, &blocked), 0);
    assert_false(sigismember(&blocked, SIGTERM));
}

/* 0 if a process that has lost the helpers does all shares and frees the team. */
static int outcome_without_helpers(team *t)
{
    record r = {0};
    int n_wrong = 0;
    (void)alarm(60);
    for (int loop = 0; loop < 100; loop++) run(t, MOST, count, &r);
    for (int k = 0; k < MOST; k++) n_wrong += r.done[k] != 100;
    team_destroy(t);
    return n_wrong > 0;
}

TEST(a_forked_process_goes_on_without_helpers)
{
    CLEANUP(free_team) team *t = team_create(3, 1);
    for (int delay = 0; delay < 2; delay++) {
        record r = {0};
        int outcome = 1;
        run(t, MOST, count, &r);
        pause_for(delay); /* helpers look for work still, or sleep */
        const pid_t child = fork();
        if (child == 0) _exit(outcome_without_helpers(t));
        assert_int_equal(waitpid(child, &outcome, 0), child);
        assert_int_equal(outcome, 0);
    }
}

TEST(shares_have_the_least_size_and_come_out_even)
{
    CLEANUP(free_team) team *t = team_create(3, 100);
    assert_int_equal(team_shares(NULL, 1000000), 1);
    assert_int_equal(team_shares(t, 0), 1);
    assert_int_equal(team_shares(t, 199), 1);
    assert_int_equal(team_shares(t, 200), 2);
    assert_int_equal(team_shares(t, 599), 3);
    assert_int_equal(team_shares(t, 600), 6);
    assert_int_equal(team_shares(t, 1000000), 12);
}
