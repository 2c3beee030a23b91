/* SPDX-License-Identifier: BSD-3-Clause */
/* What observers and callers see of a run: the state at some time, and all that dem.h tells of it. */
#ifndef DEM_SIMULATION_QUERY_H
#define DEM_SIMULATION_QUERY_H

#include "simulation/private.h"

/** Looks at a state y, [4 n], at t. */
void query_at(dem_simulation *s, double t, const double *y);

/** Looks at a time within the step in hand. */
void query_inside(dem_simulation *s, double t);

#endif
