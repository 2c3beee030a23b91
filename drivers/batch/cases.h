/* SPDX-License-Identifier: BSD-3-Clause */
/* The decks that a command asks for, lists of them looked up. */
#ifndef DEM_CASES_H
#define DEM_CASES_H

#include "command.h"

typedef struct cases {
    size_t n;
    char **paths; /* [n] */
} cases;

/** A list has a deck a line, relative to the list's folder; blanks round it do not count, and a line that begins with
 *  '#' is a comment. False, with the fault reported, if a list cannot be read or there is no case of the index. To be
 *  freed in any case. */
bool cases_find(cases *out, const command *c, outcome *o);
void cases_free(cases *all);

#endif
