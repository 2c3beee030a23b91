/* SPDX-License-Identifier: BSD-3-Clause */
/* Moves the nodes at the rim of a lattice on to the edges of its shape, so that mass, bending and stresses at curved
 * and slanted edges converge. Triangles stay sound: none gets an angle below 20 degrees. */
#ifndef DEM_SHAPE_SMOOTHING_H
#define DEM_SHAPE_SMOOTHING_H

#include <dem/dem.h>

struct shape;

/* What came out. */
typedef struct smoothing {
    dem_index n_rim; /* nodes at the rim */
    dem_index n_off; /* of them those that could not be moved on to an edge */
    dem_index n_cut; /* corners that no node is near, so that they are cut off */
    double farthest; /* m, that the worst of these n_off nodes is off its edge */
} smoothing;

/* Cuts a smooth shape out of its shape_mesh(), and moves the nodes at the rim. A few pairs of triangles get their other
 * diagonal as their common side. \return DEM_OK, DEM_ERROR_MEMORY, or DEM_ERROR_MODEL if nothing is left */
dem_status smoothing_apply(smoothing *out, dem_lattice *lattice, const struct shape *s);

#endif
