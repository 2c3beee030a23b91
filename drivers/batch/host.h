/* SPDX-License-Identifier: BSD-3-Clause */
/* Who a command works for: the program dem_batch, or another program that calls it as a function. Of the process that
 * they are in a command takes nothing for itself, be it standard streams, signals or the end. */
#ifndef DEM_HOST_H
#define DEM_HOST_H

#include <stdbool.h>
#include <stdio.h>

#include "requests.h"

typedef struct host {
    FILE *out, *err;       /* where it prints */
    bool terminal;         /* `out` is one */
    requests *requests;    /* what is asked of it */
    volatile double *part; /* of a run what is done, 0 to 1, is written there; NULL: nobody asks */
} host;

#endif
