/* SPDX-License-Identifier: BSD-3-Clause */
/* The log of a case: where it goes, how much is said, and the warnings, which its result lists too. */
#ifndef DEM_RUN_LOG_H
#define DEM_RUN_LOG_H

#include <stdbool.h>
#include <stdio.h>

#include "requests.h"

enum {
    RUN_LOG_WARNINGS = 32, /* that are kept; all are printed */
    RUN_LOG_TEXT = 512     /* bytes of one */
};

/** `out` and what follows up to `verbose` to be set, all else to 0. */
typedef struct run_log {
    FILE *out;
    volatile double *part;    /* of the run that is done, 0 to 1, for whoever asks; NULL: nobody does */
    const requests *requests; /* NULL: nobody has any */
    bool terminal;            /* progress is rewritten in place */
    bool verbose;             /* details, too */
    bool quiet;               /* warnings are kept, not printed: an earlier process of the run has printed them */
    bool inside;              /* a line of progress is not ended yet */
    size_t n_warnings;
    char warnings[RUN_LOG_WARNINGS][RUN_LOG_TEXT];
} run_log;

/** Ends a line of progress; what is printed next begins a line. */
void run_log_begin(run_log *l);

/** A line, printf-like, with its end. */
void run_log_tell(run_log *l, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** A warning, without the end of its line. */
void run_log_warn(run_log *l, const char *format, ...) __attribute__((format(printf, 2, 3)));

#endif
