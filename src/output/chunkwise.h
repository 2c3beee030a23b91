/* SPDX-License-Identifier: BSD-3-Clause */
/* Datasets that are written chunk by chunk, so that nobody has all of their rows at once. */
#ifndef DEM_OUTPUT_CHUNKWISE_H
#define DEM_OUTPUT_CHUNKWISE_H

#include "lattice/lattice_source.h"
#include "output/hdf5_rows.h"

/** Fills in n rows, from row `first` on. */
typedef void chunkwise_filler(const void *context, hsize_t first, hsize_t n, void *rows);

/** Makes a dataset of rows that are computed.
 *  \param rows  its chunk is not looked at  \return DEM_ERROR_MEMORY, DEM_ERROR_IO */
dem_status chunkwise_fill(const hdf5_file *file, hdf5_rows rows, hsize_t count, chunkwise_filler *fill,
                          const void *context);

/** Makes a dataset of an array of a lattice, of which there are n items.
 *  \param rows      its chunk is not looked at
 *  \param member    offset of the array's pointer in a dem_lattice
 *  \param per_item  rows that an item gives */
dem_status chunkwise_copy(const hdf5_file *file, hdf5_rows rows, const lattice_source *from, size_t member, dem_index n,
                          int per_item);

#endif
