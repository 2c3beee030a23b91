/* SPDX-License-Identifier: BSD-3-Clause */
/* How bodies move at t = 0, before there is a state of a simulation to ask. */
#ifndef DEM_INITIAL_MOTION_H
#define DEM_INITIAL_MOTION_H

#include <dem/lattice.h>

/* Of one body, or of all as one. To be set to 0. */
typedef struct initial_motion {
    double mass, momentum[2]; /* kg, kg m/s */
} initial_motion;

/* Adds a node; a fixed one does not move. */
void initial_motion_add(initial_motion *motion, const dem_lattice *lattice, dem_index node);

/* Velocity of the centre of mass, m/s. */
void initial_motion_velocity(double v[2], const initial_motion *motion);

#endif
