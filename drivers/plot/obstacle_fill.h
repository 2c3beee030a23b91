/* SPDX-License-Identifier: BSD-3-Clause */
/* The solid behind an obstacle's polyline, as a polygon to be filled. */
#ifndef DEM_OBSTACLE_FILL_H
#define DEM_OBSTACLE_FILL_H

#include <dem/dem.h>

#include "box.h"

enum { OBSTACLE_FILL_MORE = 34 }; /* points that an outline has at most beside those of the obstacle */

typedef struct obstacle_fill {
    size_t n;
    double *xy; /* [n][2] m */
} obstacle_fill;

/** A closed polyline is its own outline. An open one is closed on its right side, beyond all of `view`. False without
 *  memory. Caller owns out->xy.
 *  \param view  what is looked at, m */
bool obstacle_fill_outline(const dem_obstacle *obstacle, box view, obstacle_fill *out);

/** The same where it is at t, s; without points where the run has no place of one that a program moved. */
bool obstacle_fill_at(const dem_obstacle *obstacle, double t, box view, obstacle_fill *out);

#endif
