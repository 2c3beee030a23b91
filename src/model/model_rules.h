/* SPDX-License-Identifier: BSD-3-Clause */
/* What a lattice must be for a model to be compiled of it. */
#ifndef DEM_MODEL_MODEL_RULES_H
#define DEM_MODEL_MODEL_RULES_H

#include <dem/dem.h>

#include "base/ranks.h"

/** Names the first fault, with node, place and numbers.
 *  \param n_whole  nodes of the whole lattice, of which this may be a part
 *  \return DEM_OK, DEM_ERROR_MODEL, DEM_ERROR_ARGUMENT */
dem_status model_rules_check(const dem_lattice *lattice, dem_index n_whole);

/** Checks that the numbers of bodies have no holes, and that a node which needs a spring has one, or is a body of its
 *  own. Collective.
 *  \param lattice   with numbers of bodies; of the whole, or a part of it
 *  \param own       the nodes own[0] to own[1] - 1 are those of this rank
 *  \param is_loose  [nodes] 1: has no spring, and moves with no rigid body
 *  \return DEM_ERROR_MODEL, which names the first one; DEM_ERROR_MEMORY */
dem_status model_rules_check_bodies(const dem_lattice *lattice, const ranks *r, const dem_index own[2],
                                    const unsigned char *is_loose);

#endif
