/* SPDX-License-Identifier: BSD-3-Clause */
/* What is asked of a run while it goes on: by signals where it is a program (signals.h), or by another thread. */
#ifndef DEM_REQUESTS_H
#define DEM_REQUESTS_H

#include <signal.h>
#include <stdbool.h>

/** To be set to 0. Whoever asks writes 1, or the number of a signal. */
typedef struct requests {
    volatile sig_atomic_t end;        /* the signal that it is asked for by; 0: it is not */
    volatile sig_atomic_t checkpoint; /* 0: it is not asked for */
} requests;

/** The name of the signal that asks for the end; NULL: none does. */
const char *requests_end(const requests *w);

/** Whether a checkpoint was asked for since the last call. */
bool requests_checkpoint(requests *w);

#endif
