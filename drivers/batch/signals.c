/* SPDX-License-Identifier: BSD-3-Clause */
#include "signals.h"

#include <signal.h>
#include <stddef.h>
#include <sys/select.h>

static requests noted;

static void note_end(int number)
{
    noted.end = number;
}

static void note_checkpoint(int number)
{
    (void)number;
    noted.checkpoint = 1;
}

static void note_child(int number)
{
    (void)number;
}

static void set(int number, void (*handler)(int))
{
    struct sigaction before, action = {.sa_handler = handler, .sa_flags = SA_RESTART};
    (void)sigemptyset(&action.sa_mask);
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN) (void)sigaction(number, &action, NULL);
}

void signals_catch(void)
{
    set(SIGUSR1, note_checkpoint);
    set(SIGPIPE, SIG_IGN);
    set(SIGXFSZ, SIG_IGN);
}

void signals_catch_end(void)
{
    set(SIGTERM, note_end);
    set(SIGINT, note_end);
    set(SIGXCPU, note_end);
    set(SIGUSR2, note_end);
}

requests *signals_requests(void)
{
    return &noted;
}

static void block_children(int how)
{
    sigset_t children;
    (void)sigemptyset(&children);
    (void)sigaddset(&children, SIGCHLD);
    (void)sigprocmask(how, &children, NULL);
}

/* The signal is let in by signals_wait() only, so that none comes between a look for processes and the wait. */
void signals_catch_children(void)
{
    const struct sigaction action = {.sa_handler = note_child};
    (void)sigaction(SIGCHLD, &action, NULL);
    block_children(SIG_BLOCK);
}

void signals_leave_children(void)
{
    const struct sigaction action = {.sa_handler = SIG_DFL};
    (void)sigaction(SIGCHLD, &action, NULL);
    block_children(SIG_UNBLOCK);
}

void signals_wait(double seconds)
{
    const struct timespec most = {.tv_sec = (time_t)seconds,
                                  .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
    sigset_t mask;
    if (sigprocmask(SIG_SETMASK, NULL, &mask) != 0) return;
    (void)sigdelset(&mask, SIGCHLD);
    (void)pselect(0, NULL, NULL, NULL, &most, &mask);
}
