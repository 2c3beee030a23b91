/* SPDX-License-Identifier: BSD-3-Clause */
/* What cracks take by the fracture energies of what is broken. */
#ifndef DEM_MODEL_CRACK_ENERGY_H
#define DEM_MODEL_CRACK_ENERGY_H

#include "model/element_state.h"

/** What a triangle adds to a crack along a row of equilateral ones of its area: half of their side, m. */
double crack_length(const dem_lattice *lattice, dem_index triangle);

/** The sum over broken triangles of fracture energy times length and thickness, J.
 *  \param elements     NULL: all are whole
 *  \param[out] energy  0 where a broken triangle has no strength, or the lattice no moduli  \return DEM_ERROR_MEMORY */
dem_status crack_energy(const dem_lattice *lattice, const element_state *elements, double *energy);

#endif
