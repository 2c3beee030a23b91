/* SPDX-License-Identifier: BSD-3-Clause */
/* A file that is written under another name and takes its own when it is whole. */
#ifndef DEM_SHEET_H
#define DEM_SHEET_H

#include <stdio.h>

#include "task.h"

enum { SHEET_PATH = 4096 };

typedef struct sheet {
    const task *task;
    FILE *file;
    char path[SHEET_PATH];
} sheet;

/** Whether FOLDER + `before` + NAME + `behind` may be written; a file that is in the way is the outcome. To be asked of
 *  all files before the first is begun. */
bool sheet_is_free(const task *t, const char *before, const char *behind);

/** Begins it; false, and the outcome, if that cannot be. */
bool sheet_open(sheet *s, const task *t, const char *before, const char *behind);

void sheet_print(sheet *s, const char *format, ...) __attribute__((format(printf, 2, 3)));
void sheet_write(sheet *s, const void *bytes, size_t n);

/** A number with the digits that read back to what is in the file of the run. */
void sheet_number(sheet *s, double value, dem_reader_type type);

/** Gives the file its name if all is good so far, else removes it. False, and the outcome, if it could not be written;
 *  false also if it was not good. */
bool sheet_close(sheet *s, bool good);

#endif
