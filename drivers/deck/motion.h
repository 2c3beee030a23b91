/* SPDX-License-Identifier: BSD-3-Clause */
/* How a deck lets an obstacle move: the keys of &obstacle that go together, and their way into the library's struct. */
#ifndef DEM_MOTION_H
#define DEM_MOTION_H

#include <dem/dem.h>

#include "schema.h"

/* Reports keys without the motion that they belong to, and motions without the keys that they need. */
void motion_check(const schema_instance *obstacle, namelist_errors *errors);

/* Takes the default of `velocity` away where the motion is another one: stated, it would be a fault. */
void motion_drop_unused(schema_deck *groups);

/* Sets the fields by which the obstacle moves. */
void motion_set(dem_obstacle *made, const schema_instance *obstacle);

#endif
