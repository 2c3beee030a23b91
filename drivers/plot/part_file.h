/* SPDX-License-Identifier: BSD-3-Clause */
/* A file that is written as PATH.part and takes its name when it is whole. */
#ifndef DEM_PART_FILE_H
#define DEM_PART_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "outcome.h"

typedef struct part_file {
    FILE *file;
    const char *path; /* its name, the caller's */
    char *part;       /* PATH.part */
} part_file;

/** False after a fault, which is reported; then nothing is to be closed. */
bool part_file_open(part_file *p, const char *path, outcome *o);

/** The file takes the place of an older one, if all is good and could be written. False after a fault, which is
 *  reported; nothing is left then.
 *  \param fault  why it is not good, where errno does not tell */
bool part_file_close(part_file *p, bool good, const char *fault, outcome *o);

/** Nothing is left of it. */
void part_file_drop(part_file *p);

#endif
