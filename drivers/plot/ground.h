/* SPDX-License-Identifier: BSD-3-Clause */
/* The solid behind an obstacle's polyline, as a polygon to be filled. */
#ifndef DEM_GROUND_H
#define DEM_GROUND_H

#include <dem/dem.h>

#include "box.h"

typedef struct ground {
    size_t n;
    double *xy; /* [n][2] m */
} ground;

/** A closed polyline is its own outline. An open one is closed on its right side, beyond all of `view`. False without
 *  memory. Caller owns out->xy.
 *  \param view  what is looked at, m */
bool ground_outline(const dem_obstacle *obstacle, box view, ground *out);

#endif
