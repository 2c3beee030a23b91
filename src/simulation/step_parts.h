/* SPDX-License-Identifier: BSD-3-Clause */
/* The parts of a simulation that steps and events are computed with: integrator, kernel, overlaps, contacts with
 * obstacles and between bodies, queue of events. */
#ifndef DEM_SIMULATION_STEP_PARTS_H
#define DEM_SIMULATION_STEP_PARTS_H

#include "simulation/private.h"

/** Frees them, with the state of the integrator. What is left of a simulation that is not advanced itself shows and
 *  measures a state that comes to its `frame`. */
void step_parts_destroy(dem_simulation *s);

#endif
