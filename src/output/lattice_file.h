/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes the group /lattice, which dem_lattice_read() reads. */
#ifndef DEM_OUTPUT_LATTICE_FILE_H
#define DEM_OUTPUT_LATTICE_FILE_H

#include "lattice/lattice_source.h"
#include "output/hdf5_file.h"

/** Writes the arrays of a lattice, one after the other; optional ones that it does not have are left out. */
dem_status lattice_file_write(const hdf5_file *file, const lattice_source *from, int deflate);

#endif
