/* SPDX-License-Identifier: BSD-3-Clause */
/* What the library does with slabs of callers (dem/slab.h). */
#ifndef DEM_LATTICE_SLAB_H
#define DEM_LATTICE_SLAB_H

#include <dem/dem.h>

/** Checks that a slab has a place in a whole, and that its node numbers are valid, and copies the struct, of whatever
 *  version. Arrays are not copied.
 *  \return DEM_ERROR_ARGUMENT, DEM_ERROR_MODEL */
dem_status slab_read(dem_slab *ours, const dem_slab *theirs);

#endif
