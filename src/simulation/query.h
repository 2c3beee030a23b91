/* SPDX-License-Identifier: BSD-3-Clause */
/* What observers and callers see of a run: the state at some time, and all that dem.h can be asked about it. */
#ifndef DEM_SIMULATION_QUERY_H
#define DEM_SIMULATION_QUERY_H

#include "simulation/private.h"

/** Makes y, [2 dim n_rows], at t the state that is seen. */
void query_at(dem_simulation *s, double t, const double *y);

/** Makes the state at a time within the step in hand the one that is seen. */
void query_inside(dem_simulation *s, double t);

/** Does all for the state that is seen which asks functions of the caller, the external force and motions of obstacles,
 *  so that what looks at it need not: to be called in an advance before the state is shown.
 *  \return DEM_STOPPED if one has failed: then it must not be shown */
dem_status query_ask(dem_simulation *s);

/** The same of the motions of obstacles alone. */
void query_ask_poses(dem_simulation *s);

/** dem_simulation_surfaces() of a run that no rank leads. */
const dem_surfaces *query_surfaces(const dem_simulation *s);

/** dem_simulation_residual() of the state after the last step, whatever is seen. */
double query_residual(const dem_simulation *s);

#endif
