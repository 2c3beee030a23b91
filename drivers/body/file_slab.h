/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs of a body from a lattice file, which come with springs and masses, and with all that such a file may have. */
#ifndef DEM_FILE_SLAB_H
#define DEM_FILE_SLAB_H

#include <dem/slab.h>

/* Whether a slab is fit to be made by ranks: of one elastic body at rest in its shape, all of triangles, whose boundary
 * is what may touch, and of which a model can be made.
 * \return DEM_ERROR_MODEL if not; DEM_ERROR_MEMORY */
dem_status file_slab_check(const dem_slab *slab);

/* Takes positions away, which are those of rest: bodies without any may be beside this one. */
void file_slab_forget_start(dem_slab *slab);

/* Gives the strip of such a body (slab_survey.h) springs, all of the length of its shortest one. Only that one is asked
 * for, and the file has no material.
 * \return as dem_lattice_assemble() */
dem_status file_slab_join_strip(dem_lattice *strip, double rest_length);

#endif
