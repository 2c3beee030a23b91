/* SPDX-License-Identifier: BSD-3-Clause */
/* Velocity Verlet, (5) as kick, drift and kick, with root functions. The same interface as integrator.h. */
#ifndef DEM_VERLET_H
#define DEM_VERLET_H

#include <stdbool.h>

#include "motion.h"

typedef struct verlet verlet;

/** Starts at (t, y). Free with verlet_destroy. */
dem_status verlet_create(verlet **out, const motion *problem, double t, const double *y);
void verlet_destroy(verlet *V);

/** Takes one step, or goes to the first root within it (`*rooted`). The path's arrays belong to the engine and hold
 *  until its next call. DEM_ERROR_INTEGRATOR leaves the last state in force. */
dem_status verlet_step(verlet *V, path *step, bool *rooted);

/** Goes on from another state. */
void verlet_restart(verlet *V, double t, const double *y);

/** Steps and evaluations so far; the rest is 0. */
dem_counts verlet_counts(const verlet *V);

#endif
