/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of a lattice file between given nodes, for programs that share out several bodies among ranks. */
#ifndef DEM_OUTPUT_SLAB_FILE_H
#define DEM_OUTPUT_SLAB_FILE_H

#include <dem/slab.h>

/** The slab of dem_slab_read() whose own nodes have the numbers from `begin` on, before `end`, in the file; it has
 *  rim_boundary. Where there are none it has but the numbers of nodes and triangles of the whole. Exported for
 *  dem_batch; no other program may call it.
 *  \param node_ranges  NULL in it, or what an earlier call for the same file has left there: of springs and triangles
 *                      only those pieces of the file are then looked at that may have something at nodes of the
 *                      slab; to be freed
 *  \return as dem_slab_read(); DEM_ERROR_MODEL where the file has not all of these nodes */
DEM_API dem_status dem_private_slab_of_file(dem_slab *out, const char *path, dem_index **node_ranges, dem_index begin,
                                            dem_index end);

#endif
