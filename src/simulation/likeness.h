/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether functions of the caller answer alike on all ranks: each rank calls its own, and all that ranks decide by
 * themselves follows from what these return. */
#ifndef DEM_SIMULATION_LIKENESS_H
#define DEM_SIMULATION_LIKENESS_H

#include "simulation/private.h"

/** Asks where obstacles are at t. Collective; nothing where a process is alone, or no function moves an obstacle. What
 *  fails here on all ranks is none of it: the run meets that when it gets there.
 *  \return DEM_ERROR_ARGUMENT if ranks have got different poses, with an obstacle and a rank named */
dem_status likeness_check_motions(const dem_simulation *s, double t);

/** Asks for the external force in the present state, about ghosts too, and compares it with that of their owners.
 *  Collective; nothing where a process is alone, or there is none.
 *  \return DEM_ERROR_ARGUMENT if it is another one there, with a node and a rank named; DEM_ERROR_MEMORY */
dem_status likeness_check_force(dem_simulation *s);

#endif
