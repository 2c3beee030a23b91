/* SPDX-License-Identifier: BSD-3-Clause */
/* What the integrator calls: derivatives, root functions, and by how much the highest frequency has risen. The one
 * place where a simulation is described as an ODE problem. */
#ifndef DEM_SIMULATION_RIGHT_HAND_SIDE_H
#define DEM_SIMULATION_RIGHT_HAND_SIDE_H

#include "simulation/private.h"

/** The problem of a simulation whose kernel and contacts are set up. Borrows the simulation. */
ode_problem right_hand_side_problem(dem_simulation *s);

/** What the integrator needs of the domain of a model that ranks share. Of ghosts positions are exchanged, and
 *  velocities where forces depend on those of neighbours or ghosts are integrated here, too. */
ode_domain right_hand_side_domain(const dem_simulation *s);

#endif
