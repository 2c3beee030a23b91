/* SPDX-License-Identifier: BSD-3-Clause */
#include "wishes.h"

#include <stddef.h>

const char *wishes_end(const wishes *w)
{
    switch (w->end) {
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

bool wishes_checkpoint(wishes *w)
{
    const bool was = w->checkpoint != 0;
    w->checkpoint = 0;
    return was;
}
