/* SPDX-License-Identifier: BSD-3-Clause */
/* A single obstacle as a polyline: its checks, and its segments. */
#ifndef DEM_OBSTACLE_POLYLINE_H
#define DEM_OBSTACLE_POLYLINE_H

#include "obstacle/obstacle.h"

/** DEM_ERROR_MODEL names obstacle o and its fault. */
dem_status polyline_check(const dem_obstacle *obstacle, dem_index o);

/** Fills the segments of obstacle o, from set->first[o] on, and set->first[o + 1]. */
void polyline_compile(obstacle_set *set, dem_index o);

/** Segments of one polyline may have no more in common than the vertex of neighbours: otherwise there is no inside.
 *  \param[out] pair  two segments that have more; the second follows the first if it goes back over it */
bool polyline_find_crossing(dem_index pair[2], const obstacle_set *set, dem_index o);

/** DEM_ERROR_MODEL names the segments of obstacle o that meet. */
dem_status polyline_check_crossings(const obstacle_set *set, dem_index o);

#endif
