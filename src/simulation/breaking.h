/* SPDX-License-Identifier: BSD-3-Clause */
/* What is broken in a run, and all that depends on it. The public function is dem_simulation_break(). */
#ifndef DEM_SIMULATION_BREAKING_H
#define DEM_SIMULATION_BREAKING_H

#include "simulation/private.h"

/** Puts what is broken, and the energy that it took, into a checkpoint. */
dem_status breaking_save(const dem_simulation *s, dem_checkpoint *checkpoint);

/** Breaks what is broken in a checkpoint, which may be of a run in which nothing is. Before all that is listed by
 *  surfaces; lists of surface contact do not fit a state afterwards.
 *  \return DEM_ERROR_IO if it is impossible, DEM_ERROR_MEMORY */
dem_status breaking_restore(dem_simulation *s, const dem_checkpoint *checkpoint);

void breaking_destroy(dem_simulation *s);

/** Lets elements break by themselves, where the lattice has strengths or critical stretches.
 *  \return DEM_ERROR_MODEL if one is beyond its limit at the start, DEM_ERROR_MEMORY */
dem_status breaking_create(dem_simulation *s);

/** Called when the run begins, or goes on from a state that a program has changed: breaks what is over its limit, and
 *  makes surfaces those of what is whole.  \return DEM_ERROR_INTEGRATOR if that is too much, DEM_ERROR_MEMORY */
dem_status breaking_begin(dem_simulation *s);

/** Where the whole body stops at events: ends the step in hand where something breaks, if that is before its end. */
void breaking_check_step(dem_simulation *s);

/** Whether all that breaks in the step in hand has been found.  \return DEM_ERROR_MEMORY if it has not */
dem_status breaking_found(const dem_simulation *s);

/** Makes surfaces those of what is whole, in the state y, if something has broken in the last step: also where the rest
 *  of that has been dropped.  \return DEM_ERROR_MEMORY */
dem_status breaking_follow(dem_simulation *s, const double *y);

/** Called before the step in hand becomes the state: surfaces are those of what is whole at its end.
 *  \return DEM_ERROR_MEMORY */
dem_status breaking_end_step(dem_simulation *s);

#endif
