/* SPDX-License-Identifier: BSD-3-Clause */
/* What the library does with slabs of callers (dem/slab.h). */
#ifndef DEM_LATTICE_SLAB_H
#define DEM_LATTICE_SLAB_H

#include <dem/dem.h>

/** Checks what a slab is asked for by.  \return DEM_ERROR_ARGUMENT */
dem_status slab_check_out(const dem_slab *out, dem_index part, dem_index n_parts);

/** Hands a slab over to a caller, as far as the lattice of the caller's goes. */
void slab_give(dem_slab *out, const dem_slab *made);

/** Checks that a slab has a place in a whole, and that its node numbers are valid, and takes its arrays over: theirs,
 *  of whatever version, is empty afterwards.
 *  \return DEM_ERROR_ARGUMENT, DEM_ERROR_MODEL; then nothing has changed */
dem_status slab_take(dem_slab *ours, dem_slab *theirs);

#endif
