/* SPDX-License-Identifier: BSD-3-Clause */
/* The model of a domain, as one rank has it: cut from the model of the whole lattice, by the rank itself or by rank
 * 0. */
#ifndef DEM_MODEL_DOMAIN_MODEL_H
#define DEM_MODEL_DOMAIN_MODEL_H

#include "domain/slab_rows.h"
#include "model/domain_model_shares.h"
#include "model/model.h"

/** Cuts the model of a rank from one of the whole lattice, which may be destroyed afterwards. Own nodes have the
 *  masses, springs, triangles, surface edges and stresses of the whole: where the domain ends there is no boundary.
 *  Common nodes have the same; rigid bodies, and elements that may break, have no others. Ghosts whose neighbours are
 *  all here are accelerated, too, others are not. Collective.
 *  Borrows the ranks. Free with dem_model_destroy().
 *  \return DEM_ERROR_MODEL if a rank owns no node, DEM_ERROR_MEMORY */
dem_status domain_model_create(dem_model **out, const ranks *r, const dem_model *whole,
                               const domain_model_shares *shares);

/** The same where rank 0 alone has the whole: it cuts the domains of all ranks, one after the other, and sends them.
 *  Obstacles are given, as another rank has no model of the whole that they would be in.
 *  \param whole   on rank 0; not looked at elsewhere
 *  \param shares  likewise its owners
 *  \param obstacles  [n_obstacles] the same on all ranks */
dem_status domain_model_distribute(dem_model **out, const ranks *r, const dem_model *whole,
                                   const domain_model_shares *shares, const dem_obstacle *obstacles,
                                   dem_index n_obstacles);

/** The same where each rank has a slab of the whole, and owns the nodes of its range; nobody has the whole.
 *  \param rows    of a lattice that has velocities, and nothing rigid or breakable; they end, and so do the arrays of
 *                 the slab
 *  \param shares  without owners, and nodes that are near */
dem_status domain_model_gather(dem_model **out, slab_rows *rows, const domain_model_shares *shares,
                               const dem_obstacle *obstacles, dem_index n_obstacles);

#endif
