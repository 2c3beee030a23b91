/* SPDX-License-Identifier: BSD-3-Clause */
/* How a program makes the slabs of a lattice (dem/slab.h) on several ranks: rank 0 has a recipe, by which each rank
 * makes its own, so that nobody has the whole. */
#ifndef DEM_BASE_SLAB_RECIPE_H
#define DEM_BASE_SLAB_RECIPE_H

#include <dem/dem.h>

/** Makes the slab of a part, as dem_model_create_mpi_slab() takes it, from a recipe of `size` bytes.
 *  \param[out] out  from dem_slab_empty() */
typedef dem_status dem_private_slab_maker(void *program, const void *recipe, size_t size, dem_index part,
                                          dem_index n_parts, dem_slab *out);

/** What makes slabs on a rank. */
typedef struct slab_maker {
    dem_private_slab_maker *make; /**< NULL: nothing does */
    void *program;
} slab_maker;

/** What rank 0 sends to the others. */
typedef struct slab_recipe {
    const void *bytes;
    size_t size;
    const dem_obstacle *obstacles; /**< [n_obstacles] this library's, without functions of the program */
    dem_index n_obstacles;
    const dem_options *options; /**< for which the model is shared: dem_model_create_mpi_for() */
} slab_recipe;

#endif
