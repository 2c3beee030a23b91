/* SPDX-License-Identifier: BSD-3-Clause */
/* Where an obstacle is, and the power of its lasting contacts. */
#ifndef DEM_CONTACT_OBSTACLE_LOAD_H
#define DEM_CONTACT_OBSTACLE_LOAD_H

#include "contact/scene.h"
#include "obstacle/motion_law.h"

/** Adds place, angle and power of an obstacle at t.
 *  \param list  [n] closed contacts of all obstacles, with their places at t */
void obstacle_load_add_motion(dem_obstacle_load *load, const contact_scene *scene, double t, dem_index obstacle,
                              const dem_contact *list, dem_index n);

#endif
