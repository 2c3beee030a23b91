/* SPDX-License-Identifier: BSD-3-Clause */
/* A slab that ranks make a model of: checked, with what the absence of arrays stands for. */
#ifndef DEM_MODEL_SLAB_LATTICE_H
#define DEM_MODEL_SLAB_LATTICE_H

#include "domain/slab_rows.h"

/** Takes the arrays of a slab over, which is empty afterwards, and adds flags, bodies and velocities where they are
 *  missing. Free with dem_slab_free(), after a failure, too.
 *  \return DEM_ERROR_MODEL for what cannot move, and for what slabs cannot be of: rigid bodies, those that may break,
 *          those without triangles; DEM_ERROR_ARGUMENT, DEM_ERROR_MEMORY */
dem_status slab_lattice_take(dem_slab *out, dem_slab *slab);

/** Checks the bodies of all slabs together, as those of a whole are. Collective.
 *  \param rows  of the slab, while they have its lattice
 *  \return what model_rules_check_bodies() returns, with numbers of nodes in the slab */
dem_status slab_lattice_check_bodies(const dem_slab *slab, const slab_rows *rows);

/** Marks the own nodes that all ranks have in common, without rings about them, as find_common() of
 *  model/whole_lattice.c does in a whole: where there are obstacles those that may touch them, where bodies touch those
 *  on the boundary of the triangles. Marks of the rim say nothing.
 *  \param[out] out  [nodes] to be freed with free(), after a failure, too; NULL: none may be
 *  \return DEM_ERROR_MEMORY */
dem_status slab_lattice_mark_common(unsigned char **out, const dem_lattice *lattice, bool has_obstacles, bool touching);

#endif
