/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of a shape between given nodes, for programs that share out several bodies among ranks. */
#ifndef DEM_SHAPE_SHAPE_SLAB_H
#define DEM_SHAPE_SHAPE_SLAB_H

#include <dem/slab.h>

/** The slab of dem_slab_shape() of the rows whose first nodes have the numbers from `begin` on, before `end`, in the
 *  whole. Where there are none it has but the numbers of nodes and triangles of the whole. Exported for dem_batch; no
 *  other program may call it.
 *  \param counts  NULL in it, or what an earlier call for the same shape has left there, which need not count nodes and
 *                 triangles of all rows again; to be freed
 *  \return as dem_slab_shape() */
DEM_API dem_status dem_private_slab_between(dem_slab *out, const dem_shape *shape, dem_index **counts, dem_index begin,
                                            dem_index end);

#endif
