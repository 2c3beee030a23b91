/* SPDX-License-Identifier: BSD-3-Clause */
/* How far springs may be strained so that the stress of a triangle stays below a given one. */
#ifndef DEM_FRACTURE_STRESS_BOUND_H
#define DEM_FRACTURE_STRESS_BOUND_H

#include "model/element_state.h"

/** Strains, > 0, in tension and under pressure. */
typedef struct stress_bound {
    double stretch, squeeze;
} stress_bound;

/** The strains up to which of all springs that a triangle holds none of its principal stresses is larger than `stress`,
 *  Pa: in tension, and if `pressure` in size. All of its edges have springs. */
stress_bound stress_bound_of(const dem_lattice *lattice, const element_state *elements, dem_index triangle,
                             double stress, bool pressure);

#endif
