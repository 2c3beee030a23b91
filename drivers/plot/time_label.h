/* SPDX-License-Identifier: BSD-3-Clause */
/* Times as they stand above frames: all in one unit, with as few decimals as make them differ. */
#ifndef DEM_TIME_LABEL_H
#define DEM_TIME_LABEL_H

#include <stddef.h>

#include "ticks.h"

typedef struct time_label {
    ticks_prefix prefix; /* of the second */
    int decimals;
} time_label;

enum { TIME_LABEL_TEXT = TICKS_TEXT + 8 };

/** For the times t [n] in s. */
time_label time_label_for(size_t n, const double *t);

void time_label_print(const time_label *s, double t, char text[TIME_LABEL_TEXT]);

#endif
