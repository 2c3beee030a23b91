/* SPDX-License-Identifier: BSD-3-Clause */
/* What a case came to: its exit code, and the fault that it ended with. */
#ifndef DEM_OUTCOME_H
#define DEM_OUTCOME_H

#include <stdio.h>

#include <dem/status.h>

typedef enum exit_code {
    EXIT_DONE = 0,
    EXIT_USAGE = 2,
    EXIT_INVALID = 3,
    EXIT_NUMERICS = 4,
    EXIT_IO = 5,
    EXIT_MEMORY = 6,
    EXIT_TAKEN = 7,
    EXIT_STOPPED = 75 /* EX_TEMPFAIL */
} exit_code;

enum { OUTCOME_MESSAGE = 8192 }; /* bytes: a path and the library's message have room */

/** To be set to 0, but for `err`. */
typedef struct outcome {
    FILE *err; /* where faults are printed; NULL: standard error */
    exit_code code;
    char message[OUTCOME_MESSAGE]; /* "where: error: what" of the first fault; "" without one */
} outcome;

/** Prints "where: error: what". Of several faults the first is the outcome. */
void outcome_fail(outcome *o, exit_code code, const char *where, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/** The same with the message of a failure of the library. */
void outcome_fail_status(outcome *o, dem_status status, const char *where);

/** Sets code and message of what is no fault; prints nothing. */
void outcome_set(outcome *o, exit_code code, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
