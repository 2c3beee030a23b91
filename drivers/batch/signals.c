/* SPDX-License-Identifier: BSD-3-Clause */
#include "signals.h"

#include <signal.h>
#include <stddef.h>

static volatile sig_atomic_t end, wanted; /* end: the signal */

static void note_end(int number)
{
    end = number;
}

static void note_checkpoint(int number)
{
    (void)number;
    wanted = 1;
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
}

const char *signals_end(void)
{
    switch (end) {
    case 0:
        return NULL;
    case SIGINT:
        return "SIGINT";
    case SIGXCPU:
        return "SIGXCPU";
    default:
        return "SIGTERM";
    }
}

bool signals_checkpoint(void)
{
    const bool was = wanted != 0;
    wanted = 0;
    return was;
}
