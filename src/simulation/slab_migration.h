/* SPDX-License-Identifier: BSD-3-Clause */
/* What a rank keeps of its slab while nodes are shared out anew, until its new part of the run is there: its rows of
 * the last checkpoint, which nobody has as a whole. */
#ifndef DEM_SIMULATION_SLAB_MIGRATION_H
#define DEM_SIMULATION_SLAB_MIGRATION_H

#include "domain/migration.h"
#include "simulation/private.h"
#include "simulation/shared_peaks.h"

typedef struct slab_migration {
    migrating_rows state[2];                                       /* positions and velocities of nodes, */
    state_layout layout;                                           /* and what else a state has: that of no nodes, */
    double *quadratures;                                           /* which all ranks have alike */
    migrating_rows nodes[OBSERVERS_MOST], springs[OBSERVERS_MOST]; /* of peaks */
} slab_migration;

/** Copies own rows of a part that has just taken a checkpoint. Free with slab_migration_free(), after a failure, too.
 *  \param y  the state in the checkpoint, of part->layout
 *  \return DEM_ERROR_MEMORY */
dem_status slab_migration_begin(slab_migration *out, const dem_simulation *part, const double *y,
                                const shared_peaks *peaks);
void slab_migration_free(slab_migration *m);

/** A simulation of each rank's new part goes on from the checkpoint, of which it has its part then. Collective. Defined
 *  in setup.c.
 *  \param checkpoint  of the whole, but for the state, on rank 0; NULL elsewhere
 *  \return as dem_simulation_resume() */
dem_status slab_migration_resume(dem_simulation **out, const dem_model *part, const dem_options *options,
                                 const dem_checkpoint *checkpoint, slab_migration *kept);

/** Gives each rank the state of its new part. Collective.
 *  \param[out] y  a state of s->layout
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status slab_migration_end_state(slab_migration *m, const dem_simulation *s, double *y);

/** Gives each rank the peaks of its new part, as they are in the checkpoint, too. Collective.
 *  \param[out] peaks  those that there were have ended
 *  \return DEM_ERROR_MEMORY, on all ranks */
dem_status slab_migration_end_peaks(slab_migration *m, const dem_model *part, shared_peaks *peaks);

#endif
