/* SPDX-License-Identifier: BSD-3-Clause */
/* How the bodies of a model move at t = 0, before there is a state of a simulation to ask. */
#ifndef DEM_INITIAL_MOTION_H
#define DEM_INITIAL_MOTION_H

#include <dem/dem.h>

/** Velocity of the centre of mass of a body, m/s.  \param body  from 0; -1: of all bodies as one */
void initial_motion_velocity(const dem_lattice *l, dem_index body, double v[2]);

#endif
