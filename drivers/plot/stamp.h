/* SPDX-License-Identifier: BSD-3-Clause */
/* Times as they stand above frames: all in one unit, with as few decimals as tell them apart. */
#ifndef DEM_STAMP_H
#define DEM_STAMP_H

#include <stddef.h>

#include "ticks.h"

typedef struct stamp {
    ticks_prefix prefix; /* of the second */
    int decimals;
} stamp;

enum { STAMP_TEXT = TICKS_TEXT + 8 };

/** For the times t [n] in s. */
stamp stamp_for(size_t n, const double *t);

void stamp_print(const stamp *s, double t, char text[STAMP_TEXT]);

#endif
