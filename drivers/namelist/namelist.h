/* SPDX-License-Identifier: BSD-3-Clause */
/* Fortran namelist syntax: text -> groups of keys with values and places. Knows no group and no key by name.
 * Strict where a Fortran READ is lax: every fault has a line and a column, and all of them are reported. */
#ifndef DEM_NAMELIST_H
#define DEM_NAMELIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "namelist_errors.h"

enum { NAMELIST_MAX_FILE = 4 << 20 }; /* bytes: the echo of a deck of 1 MiB has room */

typedef enum namelist_kind {
    NAMELIST_NULL, /* two separators with nothing between, or r*: keeps the default */
    NAMELIST_INTEGER,
    NAMELIST_REAL,
    NAMELIST_LOGICAL,
    NAMELIST_STRING,
    NAMELIST_WORD, /* unquoted text that is none of these: the one to report it is who knows what was expected */
    NAMELIST_FAULT /* could not be read, and has been reported */
} namelist_kind;

typedef struct namelist_value {
    namelist_kind kind;
    namelist_place place;
    int64_t integer; /* INTEGER */
    double real;     /* REAL, and INTEGER converted */
    bool logical;    /* LOGICAL */
    char *text;      /* STRING: its content; otherwise as spelt in the file. Owned by the file. */
} namelist_value;

/* One assignment. `key = ...` has first = 1; `key(3) = ...` has first = 3, stride 1, and `subscript` set. */
typedef struct namelist_key {
    char *name; /* lower case; components joined by '%' */
    namelist_place place;
    bool subscript;
    int64_t first, stride;  /* element of value k is first + k * stride, from 1 */
    size_t n_values;        /* 0: there is a fault, and it has been reported */
    namelist_value *values; /* repeat counts r*c expanded; the values of one share their text */
} namelist_key;

typedef struct namelist_group {
    char *name; /* lower case */
    namelist_place place;
    size_t n_keys;
    namelist_key *keys; /* in the order of the file, repeated ones included */
} namelist_group;

typedef struct namelist {
    size_t n_groups;
    namelist_group *groups;
    bool unreadable; /* too large, or no text: that has been reported, and nothing else was looked at */
} namelist;

/* Parses `size` bytes; syntax faults are appended to `errors` and reading goes on behind them.
 * Returns false only when memory runs out (`out` is then empty). Free `out` with namelist_free in any case. */
bool namelist_parse(namelist *out, const char *text, size_t size, namelist_errors *errors);
void namelist_free(namelist *list);

/* Takes the keys of `from` into group `at`, in the place of those of their names; `at` = n_groups: as a group of its
 * own. `from` is then empty. Returns false, and has done nothing, when memory runs out. */
bool namelist_merge(namelist *list, size_t at, namelist_group *from);

#endif
