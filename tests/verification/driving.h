/* SPDX-License-Identifier: BSD-3-Clause */
/* What drives triangles to break, worked out from the stresses and strains that a simulation shows. */
#ifndef DEM_TEST_DRIVING_H
#define DEM_TEST_DRIVING_H

#include <dem/dem.h>

/** The triangle, of those that are whole, with the largest principal value of the mean of its corners' stresses.
 *  \return this value, Pa */
double driving_most(const dem_simulation *simulation, const dem_lattice *l, dem_index *triangle);

/** The triangles that are whole at the spring with the largest strain, of those that have one.
 *  \param[out] triangle  [2]
 *  \return this strain */
double driving_most_strain(const dem_simulation *simulation, const dem_lattice *l, dem_index *n, dem_index *triangle);

#endif
