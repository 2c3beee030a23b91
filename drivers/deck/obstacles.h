/* SPDX-License-Identifier: BSD-3-Clause */
/* The obstacles of a deck: from the keys of &obstacle to polylines. Profiles are sampled by profile.h, the keys of
 * motions are motion.h's. */
#ifndef DEM_OBSTACLES_H
#define DEM_OBSTACLES_H

#include <dem/dem.h>

#include "schema.h"

/* Reports keys that do not go together, and points that make no polyline. */
void obstacles_check(const schema_deck *groups, namelist_errors *errors);

/* Takes the defaults of keys away that a choice does not use: they mean nothing, and stated they are faults. */
void obstacles_drop_unused(schema_deck *groups);

/* Makes those of a deck without faults, one for each group; polylines that meet themselves are reported. Free with
 * obstacles_free(). NULL when memory runs out. */
dem_obstacle *obstacles_make(const schema_deck *groups, namelist_errors *errors);
void obstacles_free(dem_obstacle *list, dem_index n);

/* Obstacles as they stand at t = 0, at rest: an oscillation may begin off its middle. NULL when memory runs out. Free
 * with obstacles_free(). */
dem_obstacle *obstacles_still(const dem_obstacle *list, dem_index n);

#endif
