/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints where ranks share the model. While a run goes on each rank has one of its own part, from which it goes
 * on; that of rank 0 becomes one of the whole, as a process alone has it, which any number of ranks can go on from. */
#ifndef DEM_SIMULATION_SHARED_CHECKPOINT_H
#define DEM_SIMULATION_SHARED_CHECKPOINT_H

#include "simulation/slab_migration.h"

/** Makes rank 0's checkpoint of its part one of the whole, but for the state of a part of a run that rank 0 leads
 *  (simulation/leader_checkpoint.h). Collective.  \return DEM_ERROR_MEMORY */
dem_status shared_checkpoint_gather(const dem_simulation *s, dem_checkpoint *checkpoint);

/** The state in the last checkpoint of a part of a run that rank 0 leads, of s->layout. */
const double *shared_checkpoint_state(const dem_simulation *part);

/** Makes a checkpoint of each rank's part from one of the whole. Collective.
 *  \param whole  on rank 0; not looked at elsewhere
 *  \param kept   of which the state is taken over, as ranks have kept it; NULL: it is rank 0's
 *  \return DEM_ERROR_IO if it is of another model, DEM_ERROR_MEMORY; on all ranks */
dem_status shared_checkpoint_scatter(const dem_simulation *s, const dem_checkpoint *whole, slab_migration *kept,
                                     dem_checkpoint *part);

#endif
