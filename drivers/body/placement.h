/* SPDX-License-Identifier: BSD-3-Clause */
/* A body of the deck in the lattice of all: its nodes, and how its own coordinates were turned and shifted. */
#ifndef DEM_PLACEMENT_H
#define DEM_PLACEMENT_H

#include <math.h>

#include <dem/dem.h>

typedef struct placement {
    dem_index first, n_nodes;
    double angle, offset[2]; /* radians, m */
} placement;

/* A place in space in the body's own coordinates. */
static inline void placement_own(const placement *p, const double x[2], double own[2])
{
    const double c = cos(p->angle), s = sin(p->angle), dx = x[0] - p->offset[0], dy = x[1] - p->offset[1];
    own[0] = c * dx + s * dy;
    own[1] = c * dy - s * dx;
}

#endif
