/* SPDX-License-Identifier: BSD-3-Clause */
/* A key of a deck that the command line gives: --set group.key=value, or group(k).key=value for the k-th group of that
 * name. Values are spelt as in a deck, but strings need no quotes; an empty one takes the key away. */
#ifndef DEM_SETTING_H
#define DEM_SETTING_H

#include "namelist.h"

typedef struct setting {
    const char *text; /* the whole */
    int name_length;  /* of the group's name, with which it begins */
    long number;      /* of the group, from 1; 0: the only one */
    const char *assignment;
} setting;

/* Takes a text apart, which is kept; false if it is not of the form. */
bool setting_parse(setting *out, const char *text);

/* Gives the key to its group in `list`, which is made if there is none of that name. Faults are appended to `errors` at
 * `line`, as is whatever is found at fault in the value later on. Returns false only when memory runs out. */
bool setting_apply(const setting *s, int line, namelist *list, namelist_errors *errors);

#endif
