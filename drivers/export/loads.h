/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on the nodes of a run besides springs, as its deck says it: a file has it in no other place. */
#ifndef DEM_LOADS_H
#define DEM_LOADS_H

#include "task.h"

typedef struct loads {
    bool known;          /* the run has a deck */
    double gravity[2];   /* m/s^2 */
    double mass_damping; /* 1/s */
} loads;

/** False, and the outcome, without memory. */
bool loads_find(loads *out, const task *t);

#endif
