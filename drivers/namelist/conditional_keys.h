/* SPDX-License-Identifier: BSD-3-Clause */
/* Keys of a group that only some choices of another of its keys use. */
#ifndef DEM_CONDITIONAL_KEYS_H
#define DEM_CONDITIONAL_KEYS_H

#include "schema.h"

typedef struct conditional_key {
    const char *key;
    const char *choices; /* that use it */
    bool needed;         /* by those */
} conditional_key;

typedef struct conditional_keys {
    const char *group, *by; /* the key that chooses */
    size_t n;
    const conditional_key *keys; /* [n] */
} conditional_keys;

/* Reports keys that the choice of a group needs and that are not given, and those given that it does not use. Where the
 * choice itself is at fault, or missing, nothing can be said. */
void conditional_keys_check(const schema_instance *group, const conditional_keys *table, namelist_errors *errors);

/* Takes the defaults of keys away that are not used: they mean nothing, and stated they are faults. */
void conditional_keys_drop(schema_deck *groups, const conditional_keys *table);

#endif
