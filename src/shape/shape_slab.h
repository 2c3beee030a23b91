/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of a shape between given nodes, for programs that share out several bodies among ranks. */
#ifndef DEM_SHAPE_SHAPE_SLAB_H
#define DEM_SHAPE_SHAPE_SLAB_H

#include <stdbool.h>

#include <dem/slab.h>

/** Takes more triangles out of rows of the lattice of a shape, by their nodes alone, of cells of squares both.
 *  \param keep  [n_triangles] those that there are; those that are to go become false
 *  \param begin, end  triangles of which no other rows have a say in what is counted */
typedef dem_status dem_private_rows_cut(void *program, const dem_lattice *rows, bool *keep, dem_index begin,
                                        dem_index end);

/** What slabs are made of besides the shape, and what is found of the whole by a call that counts its rows. */
typedef struct dem_private_rows {
    dem_private_rows_cut *cut; /**< NULL: nothing more is taken */
    void *program;
    dem_index n_taken;       /**< found: triangles that it takes */
    dem_shape_report report; /**< found, but for idle_void */
} dem_private_rows;

/** The slab of dem_slab_shape() of the rows whose first nodes have the numbers from `begin` on, before `end`, in the
 *  whole. Where there are none it has but the numbers of nodes and triangles of the whole. Exported for dem_batch; no
 *  other program may call it.
 *  \param counts  NULL in it, or what an earlier call for the same rows has left there, which need not count nodes and
 *                 triangles of all of them again: a list, of which the first number says how many follow; to be
 *                 freed
 *  \return as dem_slab_shape(), or what `cut` does */
DEM_API dem_status dem_private_slab_between(dem_slab *out, const dem_shape *shape, dem_private_rows *rows,
                                            dem_index **counts, dem_index begin, dem_index end);

#endif
