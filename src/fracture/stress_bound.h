/* SPDX-License-Identifier: BSD-3-Clause */
/* How far springs may be strained so that the stress of a triangle stays below a given one. */
#ifndef DEM_FRACTURE_STRESS_BOUND_H
#define DEM_FRACTURE_STRESS_BOUND_H

#include "model/element_state.h"

/** The strain, in size, up to which of all springs that a triangle holds none of its principal stresses is larger in
 *  size than `stress`, Pa. All of its edges have springs. */
double stress_bound_strain(const dem_lattice *lattice, const element_state *elements, dem_index triangle,
                           double stress);

#endif
