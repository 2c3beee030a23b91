/* SPDX-License-Identifier: BSD-3-Clause */
/* The part of coupled triangles in the bound of the frequencies: what stands beside the blocks of springs and areas. */
#ifndef DEM_MODEL_COUPLED_BOUND_H
#define DEM_MODEL_COUPLED_BOUND_H

#include "elastic/couplings.h"

/** Adds blocks C_i such that about the rest shape, with S_i of springs_block() and T_i of triangles_block(),
 *  u.K u <= sum of u_i.(2 S_i + 3 T_i + C_i) u_i for the tangent stiffness K.
 *  \param[in,out] block  [n_nodes] N/m */
dem_status coupled_bound_add(const dem_lattice *lattice, const springs *s, const couplings *c, sym2 *block);

#endif
