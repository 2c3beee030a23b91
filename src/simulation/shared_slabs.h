/* SPDX-License-Identifier: BSD-3-Clause */
/* A model of slabs that a program makes on each rank, by a recipe that rank 0 has: nobody has the whole. */
#ifndef DEM_SIMULATION_SHARED_SLABS_H
#define DEM_SIMULATION_SHARED_SLABS_H

#include "base/slab_recipe.h"
#include "model/whole_of_parts.h"

/** Makes the model of each rank's part. Collective.
 *  \param recipe  on rank 0; NULL elsewhere
 *  \return as dem_model_create_mpi_slab(), and the first failure of a maker, on all ranks */
dem_status shared_slabs_create(dem_model **part, const ranks *r, const slab_maker *maker, const slab_recipe *recipe);

#endif
