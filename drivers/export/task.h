/* SPDX-License-Identifier: BSD-3-Clause */
/* What is to be exported, and where to. */
#ifndef DEM_TASK_H
#define DEM_TASK_H

#include <stdbool.h>

#include <dem/reader.h>

#include "frame_list.h"
#include "outcome.h"

typedef struct task {
    const char *input; /* path of the run */
    const dem_reader *reader;
    frame_list frames;  /* in the order asked for */
    const char *folder; /* "", or ends in / */
    const char *name;   /* what the names of files are made of */
    bool overwrite;
    outcome *outcome;
} task;

/** Prints "dem_export: INPUT: warning: what" to standard error. */
void task_warn(const task *t, const char *what);

/** The outcome of a call of the library; false after a failure. */
bool task_holds(const task *t, dem_status status);

/** Zeroed array of n items, never of no bytes; without memory NULL, which is the outcome. */
void *task_allocate(const task *t, dem_index n, size_t size);

#endif
