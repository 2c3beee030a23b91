/* SPDX-License-Identifier: BSD-3-Clause */
/* Keys of a group that only some choices of another of its keys use. */
#ifndef DEM_USES_H
#define DEM_USES_H

#include "schema.h"

typedef struct uses_key {
    const char *key;
    const char *choices; /* that use it */
    bool needed;         /* by those */
} uses_key;

typedef struct uses {
    const char *group, *by; /* the key that chooses */
    size_t n;
    const uses_key *keys; /* [n] */
} uses;

/* Reports keys that the choice of a group needs and that are not given, and those given that it does not use. Where the
 * choice itself is at fault, or missing, nothing can be said. */
void uses_check(const schema_instance *group, const uses *table, namelist_errors *errors);

/* Takes the defaults of keys away that are not used: they mean nothing, and stated they are faults. */
void uses_drop(schema_deck *groups, const uses *table);

#endif
