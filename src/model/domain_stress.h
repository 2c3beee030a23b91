/* SPDX-License-Identifier: BSD-3-Clause */
/* The stresses of a domain, of which some triangles beside it have shares. These are kept, and the lattice about the
 * domain is put together of both when stresses are first asked for. */
#ifndef DEM_MODEL_DOMAIN_STRESS_H
#define DEM_MODEL_DOMAIN_STRESS_H

#include "model/domain_cut.h"

/** Makes the map of stresses of the model of a cut, whose lattice about the domain is still there; that of the domain
 *  alone, the springs and couplings of the model are borrowed, and looked at when rows are made.
 *  \param node, triangle  of all in the lattice about the domain the numbers in the domain; -1: beside it
 *  \return DEM_ERROR_MEMORY */
dem_status domain_stress_create(const domain_cut *c, const dem_index *node, const dem_index *triangle);

#endif
