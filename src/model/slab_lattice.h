/* SPDX-License-Identifier: BSD-3-Clause */
/* A slab that ranks make a model of: checked, with what the absence of arrays stands for. */
#ifndef DEM_MODEL_SLAB_LATTICE_H
#define DEM_MODEL_SLAB_LATTICE_H

#include <dem/dem.h>

/** Takes the arrays of a slab over, which is empty afterwards, and adds flags, bodies and velocities where they are
 *  missing. Free with dem_slab_free(), after a failure, too.
 *  \return DEM_ERROR_MODEL for what cannot move, for nodes without springs, and for what slabs cannot be of: several
 *          bodies, rigid ones, those that may break, those without triangles; DEM_ERROR_ARGUMENT, DEM_ERROR_MEMORY */
dem_status slab_lattice_take(dem_slab *out, dem_slab *slab);

#endif
