/* SPDX-License-Identifier: BSD-3-Clause */
/* How a program makes the slabs of a lattice (dem/slab.h) on several ranks: rank 0 has a recipe, by which each rank
 * makes its own, so that nobody has the whole. */
#ifndef DEM_BASE_SLAB_RECIPE_H
#define DEM_BASE_SLAB_RECIPE_H

#include <dem/dem.h>

/** Which of n_parts slabs is wanted: of those whose rows begin at the nodes from first[part] on, before
 *  first[part + 1]. */
typedef struct slab_share {
    dem_index part, n_parts;
    const dem_index *first; /**< [n_parts + 1] from 0 to the number of nodes; NULL: as its maker shares them out */
} slab_share;

/** Makes a slab, as dem_model_create_mpi_slab() takes it, from a recipe of `size` bytes.
 *  \param[out] out  from dem_slab_empty()
 *  \return DEM_ERROR_MODEL, if a part has no rows; others */
typedef dem_status dem_private_slab_maker(void *program, const void *recipe, size_t size, const slab_share *which,
                                          dem_slab *out);

/** What a maker returns where a file is not, or no more, what the recipe was made by. Exported for dem_batch; no other
 *  program may call it. Defined in simulation/shared_slabs.c.
 *  \return DEM_ERROR_IO, with the message */
DEM_API dem_status dem_private_slab_refuse(const char *message);

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
    const dem_index *first;     /**< [ranks + 1] as in slab_share; or NULL */
} slab_recipe;

#endif
