/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of dem_export. */
#ifndef DEM_EXPORT_H
#define DEM_EXPORT_H

#include <stdio.h>

#include "task.h"

typedef enum export_action { EXPORT_FILES, EXPORT_HELP, EXPORT_VERSION } export_action;

/** Texts are those of argv. */
typedef struct export
{
    export_action action;
    const char *input;
    const char *output; /* NULL: the run's name, here */
    const char *frames; /* NULL: all */
    bool (*write)(const task *t);
    bool overwrite;
}
export;

/** What is wrong with it is said on standard error; the exit code for it. */
exit_code export_parse(export *out, char **argv);

void export_help(FILE *out);

#endif
