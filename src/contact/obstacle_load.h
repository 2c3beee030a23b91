/* SPDX-License-Identifier: BSD-3-Clause */
/* Where an obstacle is, and the power of its lasting contacts. */
#ifndef DEM_CONTACT_OBSTACLE_LOAD_H
#define DEM_CONTACT_OBSTACLE_LOAD_H

#include <dem/dem.h>

#include "obstacle/pose.h"

/** Adds place, angle and power of an obstacle in a pose.
 *  \param list  [n] closed contacts of all obstacles, with their places at that time */
void obstacle_load_add_motion(dem_obstacle_load *load, const pose *at, dem_index obstacle, const dem_contact *list,
                              dem_index n);

#endif
