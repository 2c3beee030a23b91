/* SPDX-License-Identifier: BSD-3-Clause */
/* How each rank gets its part of a run that rank 0 leads, and ends it. All of it is collective, but ending. */
#ifndef DEM_SIMULATION_LED_PARTS_H
#define DEM_SIMULATION_LED_PARTS_H

#include "simulation/led_ranks.h"

/** Makes the part, by the problem that rank 0 has put into the entries, from its cut of the whole or from the slab that
 *  there is; and what it begins from after led_parts_migrate().
 *  \param checkpoint  of the whole, on rank 0, if it `resumes`; else NULL
 *  \return as domain_model_create() and dem_simulation_create(); then there is none */
dem_status led_parts_create(led_run *l, dem_checkpoint *entries, bool resumes, const dem_checkpoint *checkpoint);

/** Makes the model of a slab, on all ranks but rank 0, in place of the model that there is.
 *  \param is_first  whether rank 0 makes a model of the whole with it: else it has one */
void led_parts_make_slab(led_run *l, bool is_first);

/** The same on rank 0, which has a model of the whole.
 *  \param first  see slab_share
 *  \return as shared_slabs_create(); then there is none. DEM_ERROR_IO if it is another lattice than before */
dem_status led_parts_remake_slab(led_run *l, const dem_index *first);

/** Keeps rows of the part's last checkpoint, for the part that is made next, and ends it and its model, which is a
 *  slab's; rank 0 learns how many nodes each has had.
 *  \return DEM_ERROR_MEMORY; then all is as it was */
dem_status led_parts_migrate(led_run *l);

/** Ends the part, and its model, unless that is a slab's; and this. */
void led_parts_drop(led_run *l);
void led_parts_drop_model(led_run *l);

#endif
