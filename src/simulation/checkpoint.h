/* SPDX-License-Identifier: BSD-3-Clause */
/* What a checkpoint contains of a run: all that its further motion depends on, and its sums and counts so far. What
 * follows from these is not in it, and is computed again where a run goes on from its checkpoint. */
#ifndef DEM_SIMULATION_CHECKPOINT_H
#define DEM_SIMULATION_CHECKPOINT_H

#include "simulation/private.h"

/** Puts the state after the last committed step into a checkpoint.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_take(dem_simulation *s, dem_checkpoint *checkpoint);

/** Makes the state that of a checkpoint, whatever there was before.
 *  \return DEM_ERROR_IO if the checkpoint is of another model or impossible; the simulation must not go on then */
dem_status checkpoint_restore(dem_simulation *s, const dem_checkpoint *checkpoint);

#endif
