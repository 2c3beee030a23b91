/* SPDX-License-Identifier: BSD-3-Clause */
/* The checkpoint of a run that rank 0 leads. It is that of rank 0's part, but for the state, of which each rank keeps
 * its part until the next checkpoint: it is gathered when a file gets it, or somebody looks at it. */
#ifndef DEM_SIMULATION_LEADER_CHECKPOINT_H
#define DEM_SIMULATION_LEADER_CHECKPOINT_H

#include "simulation/led_ranks.h"

/** Makes the whole's checkpoint from what the part of rank 0 has taken, which has its state afterwards, and nothing
 *  else.  \return DEM_ERROR_MEMORY */
dem_status leader_checkpoint_take(led_run *l, dem_checkpoint *from);

/** Hands over positions, 0, or velocities, 1, of all nodes in the last checkpoint. Collective.
 *  \param take  on rank 0; NULL elsewhere
 *  \return as gather_chunks() */
dem_status leader_checkpoint_answer(const led_run *l, dem_index number, rows_taker *take, void *context);

#endif
