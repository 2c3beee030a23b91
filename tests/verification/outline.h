/* SPDX-License-Identifier: BSD-3-Clause */
/* How deep a point is inside a body, by going round all of its boundary. */
#ifndef DEM_TEST_OUTLINE_H
#define DEM_TEST_OUTLINE_H

#include <dem/dem.h>

typedef struct outline {
    dem_index n;
    dem_index *ends; /* [n][2] sides of one triangle only, the body on their left */
} outline;

outline outline_create(const dem_lattice *lattice);
void outline_free(outline *o);

/** Depth of p in the body with nodes at x [n][2], m: its distance to the boundary, < 0 outside. */
double outline_depth(const outline *o, const double *x, const double p[2]);

#endif
