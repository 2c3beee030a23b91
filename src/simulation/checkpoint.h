/* SPDX-License-Identifier: BSD-3-Clause */
/* What a record has of a run: all that its further motion depends on, and its sums and counts so far. What can be
 * worked out from that is not in it, and is worked out again where a run goes on from its record. */
#ifndef DEM_SIMULATION_CHECKPOINT_H
#define DEM_SIMULATION_CHECKPOINT_H

#include "simulation/private.h"

/** Puts the state after the last committed step into a record.  \return DEM_ERROR_MEMORY */
dem_status checkpoint_take(dem_simulation *s, dem_record *record);

/** Makes the state that of a record; nothing else of the run shows in it any more.
 *  \return DEM_ERROR_IO if the record is of another model or cannot be one; the run is of no use then */
dem_status checkpoint_restore(dem_simulation *s, const dem_record *record);

#endif
