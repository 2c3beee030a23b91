/* SPDX-License-Identifier: BSD-3-Clause */
/* Positions and velocities for those who look at one of them at a time, as writers of files do: of a run that ranks
 * make dem_simulation_state() gathers both, and keeps them. Defined in simulation/motion_source.c. */
#ifndef DEM_BASE_MOTION_SOURCE_H
#define DEM_BASE_MOTION_SOURCE_H

#include <dem/dem.h>

/** Copies those of the state that is seen.
 *  \param[out] out  [nodes][2] m, or m/s  \return DEM_ERROR_MEMORY */
dem_status dem_private_positions(const dem_simulation *simulation, double *out);
dem_status dem_private_velocities(const dem_simulation *simulation, double *out);

#endif
