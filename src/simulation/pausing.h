/* SPDX-License-Identifier: BSD-3-Clause */
/* Pauses of the ramps after breaks, with the option `pause`. */
#ifndef DEM_SIMULATION_PAUSING_H
#define DEM_SIMULATION_PAUSING_H

#include "simulation/private.h"

/** Something has broken in the state y at t: ramps stand still from there on.
 *  \return whether prescribed velocities in y have changed */
bool pausing_begin(dem_simulation *s, double t, double *y);

/** Called when the end of a step has become the state: begins a pause, or ends it if the bodies are at rest.
 *  \param broken  whether something has broken in the step
 *  \return whether prescribed velocities in the state have changed: the integrator must begin anew */
bool pausing_end_step(dem_simulation *s, bool broken);

/** A run without the option puts nothing into a checkpoint. */
dem_status pausing_save(const dem_simulation *s, dem_checkpoint *checkpoint);

/** \return DEM_ERROR_IO if the pause in the checkpoint is impossible, or the option is not that of its run */
dem_status pausing_restore(dem_simulation *s, const dem_checkpoint *checkpoint);

#endif
