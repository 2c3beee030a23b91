/* SPDX-License-Identifier: BSD-3-Clause */
/* Moving a body along gravity to a given distance from the obstacles, and which points of theirs are in it then. */
#ifndef DEM_CLEARANCE_H
#define DEM_CLEARANCE_H

#include <stdbool.h>

#include <dem/dem.h>

/* The shift along `gravity` (not 0) after which the smallest dem_model_gap() of the nodes that may touch, where their
 * motion starts, is `clearance`. A body nearer than that or inside an obstacle goes back to the first place free
 * of it; from there, or from where it is, it goes on until it is as near as that for the first time.
 * Returns false if no obstacle lies in its way. */
bool clearance_shift(double shift[2], const dem_model *model, const double gravity[2], double clearance);

/* A point of an obstacle in the material of a body. */
typedef struct clearance_spike {
    dem_index obstacle, point; /* from 0 */
    double x[2];               /* m */
    double depth;              /* m, to the nearest side of the body; 0: there is no such point */
} clearance_spike;

/* The point that lies deepest in the triangles that can move, where their motion starts. Only triangles are material:
 * springs alone let points pass. Returns false when memory runs out. */
bool clearance_find_spike(clearance_spike *deepest, const dem_lattice *lattice, const dem_obstacle *list,
                          dem_index n_obstacles);

#endif
