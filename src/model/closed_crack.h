/* SPDX-License-Identifier: BSD-3-Clause */
/* How a coupled triangle of which nothing is left in tension resists pressure along its edges. */
#ifndef DEM_MODEL_CLOSED_CRACK_H
#define DEM_MODEL_CLOSED_CRACK_H

#include <dem/dem.h>

/** What stays of the stiffness of each edge under pressure.
 *  \param share      [3] N/m, of the springs of the edges, edge c from corner c to the next
 *  \param[out] part  [3] over these; all of them together resist no strain more than the whole triangle does */
void closed_crack_parts(const dem_lattice *lattice, dem_index triangle, const double share[3], double part[3]);

#endif
