/* SPDX-License-Identifier: BSD-3-Clause */
/* Observers of rank 0's part in a run that it leads: they call those of the whole, while the other ranks take calls. */
#ifndef DEM_SIMULATION_LEADER_OBSERVERS_H
#define DEM_SIMULATION_LEADER_OBSERVERS_H

#include "simulation/led_ranks.h"

/** What a rank observes its part with. The context is the run, of frames a relay. */
typedef struct led_observers {
    dem_status (*step)(void *context, const dem_simulation *part);
    dem_status (*before)(void *context, const dem_simulation *part); /* of a step in which something touches */
    dem_status (*event)(void *context, const dem_simulation *part, const dem_event *event);
    dem_status (*broken)(void *context, const dem_simulation *part, const dem_break *what);
    dem_status (*frame)(void *context, const dem_simulation *part);
    dem_status (*checkpoint)(void *context, const dem_simulation *part, dem_checkpoint *checkpoint);
} led_observers;

extern const led_observers leader_observers;

/** The whole shows what the part of rank 0 does; what is known of that is asked for anew. */
void leader_observers_show(const led_run *l);

/** Looks which nodes may touch soon.  \param checkpoint  NULL: from the start on  \return DEM_ERROR_IO,
 *  DEM_ERROR_MEMORY */
dem_status leader_observers_look_ahead(led_run *l, const dem_checkpoint *checkpoint);

#endif
