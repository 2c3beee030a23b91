/* SPDX-License-Identifier: BSD-3-Clause */
/* Things with the same two numbers, up to rounding, are of one kind. */
#ifndef DEM_KINDS_H
#define DEM_KINDS_H

#include "task.h"

typedef struct kinds_pair {
    double a, b;
} kinds_pair;

typedef struct kinds {
    dem_index n;
    dem_index *of;      /* [number of things] the kind of each, from 0 */
    kinds_pair *values; /* [n] ascending */
} kinds;

/** Free with kinds_free(), after a failure too.  \param pairs  [n] finite */
bool kinds_find(kinds *out, const task *t, dem_index n, const kinds_pair *pairs);
void kinds_free(kinds *k);

#endif
