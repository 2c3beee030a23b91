/* SPDX-License-Identifier: BSD-3-Clause */
/* What a case came to as one line of JSON, for programs: on standard output and in NAME.json, which marks a run as
 * done. docs/output.md lists its fields. */
#ifndef DEM_RESULT_H
#define DEM_RESULT_H

#include <time.h>

#include "command.h"
#include "outcome.h"
#include "relaxation.h"
#include "report.h"

typedef struct result {
    const char *deck;       /* its file */
    const command *command; /* for its settings */
    const deck *read;       /* NULL: it has faults */
    const char *output;     /* NAME.vtkhdf; NULL: not known */
    const dem_simulation *simulation;
    const report *report; /* NULL: the run has not begun */
    const relaxation *rest;
    const outcome *outcome;
    time_t start;
    double seconds;
} result;

/** The line with its end, malloc'ed; NULL when memory runs out. */
char *result_line(const result *r);

/** Puts the line into a file of this name, all of it or nothing, and reports if that fails. */
void result_write(const char *path, const char *line, outcome *o);

/** The line of a run of this hash that is done, malloc'ed; NULL if the file has none. */
char *result_read_done(const char *path, const char *run_hash);

#endif
