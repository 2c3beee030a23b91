/* SPDX-License-Identifier: BSD-3-Clause */
/* Faults found in a deck, each with its place: of syntax, of keys and values, and of what they mean together. They are
 * collected, so that a user sees all of them at once. */
#ifndef DEM_NAMELIST_ERRORS_H
#define DEM_NAMELIST_ERRORS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct namelist_place {
    int line, column; /* from 1; a line of 0 or less is none of the file */
} namelist_place;

/* A fault, without file name: the caller prints "file:line:column: error: text". */
typedef struct namelist_error {
    namelist_place place;
    char *text;
} namelist_error;

typedef struct namelist_errors {
    size_t n, capacity;
    namelist_error *list;
    bool out_of_memory; /* an error could not be stored */
} namelist_errors;

/* Appends a fault, printf-like. From the 1000th on they are counted as one. */
void namelist_errors_add(namelist_errors *errors, namelist_place place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Sorts by place, stable. */
void namelist_errors_sort(namelist_errors *errors);
void namelist_errors_free(namelist_errors *errors);

#endif
