/* SPDX-License-Identifier: BSD-3-Clause */
/* Moves the nodes at the rim of a lattice on to the edges of its shape, so that mass, bending and stresses at curved
 * and slanted edges converge. Triangles stay sound: none gets an angle below 20 degrees. */
#ifndef DEM_SMOOTHING_H
#define DEM_SMOOTHING_H

#include <dem/dem.h>

#include "shape.h"

/* What came out. */
typedef struct smoothing {
    double least_angle; /* degrees, of all triangles */
    dem_index n_rim;    /* nodes at the rim */
    dem_index n_off;    /* of them those that could not be moved on to an edge */
    double farthest;    /* m, of these from their edges */
} smoothing;

/* Takes a lattice that shape_cut() has cut out of equilateral triangles for a smooth shape, without springs. It loses
 * what hangs on it by nodes alone and what gets flat; a few pairs of triangles get their other diagonal as their common
 * side. \return DEM_OK, DEM_ERROR_MEMORY, or DEM_ERROR_MODEL if nothing is left */
dem_status smoothing_apply(smoothing *out, dem_lattice *lattice, const shape *s);

#endif
