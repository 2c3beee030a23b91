/* SPDX-License-Identifier: BSD-3-Clause */
/* The part of coupled triangles in the bound of the frequencies: what stands beside the blocks of springs and areas. */
#ifndef DEM_MODEL_COUPLED_BOUND_H
#define DEM_MODEL_COUPLED_BOUND_H

#include "elastic/couplings.h"

/** What the triangles of a lattice, coupled or not, give to each spring that is an edge of theirs, N/m.
 *  \param[out] given  [n_springs] to be freed with free()  \return DEM_ERROR_MEMORY */
dem_status coupled_bound_given(double **given, const dem_lattice *lattice, const springs *s);

/** Adds blocks C_i such that about the rest shape, with S_i of springs_block() and T_i of triangles_block(),
 *  u.K u <= sum of u_i.(2 S_i + 3 T_i + C_i) u_i for the tangent stiffness K.
 *  \param given           that of coupled_bound_given(), by all triangles at these springs
 *  \param[in,out] block  [n_nodes] N/m */
void coupled_bound_add(const dem_lattice *lattice, const couplings *c, const double *given, sym2 *block);

#endif
