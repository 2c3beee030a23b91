/* SPDX-License-Identifier: BSD-3-Clause */
/* What a lattice must be for a model to be compiled of it. */
#ifndef DEM_MODEL_MODEL_RULES_H
#define DEM_MODEL_MODEL_RULES_H

#include <dem/dem.h>

/** Names the first fault, with node, place and numbers.
 *  \param n_whole  nodes of the whole lattice, of which this may be a part
 *  \return DEM_OK, DEM_ERROR_MODEL, DEM_ERROR_ARGUMENT */
dem_status model_rules_check(const dem_lattice *lattice, dem_index n_whole);

#endif
