/* SPDX-License-Identifier: BSD-3-Clause */
#include "requests.h"

#include <stddef.h>

const char *requests_end(const requests *w)
{
    switch (w->end) {
    case 0:
        return NULL;
    case SIGINT:
        return "SIGINT";
    case SIGXCPU:
        return "SIGXCPU";
    case SIGUSR2:
        return "SIGUSR2";
    default:
        return "SIGTERM";
    }
}

bool requests_checkpoint(requests *w)
{
    const bool was = w->checkpoint != 0;
    w->checkpoint = 0;
    return was;
}
