/* SPDX-License-Identifier: BSD-3-Clause */
/* Chunks of a dataset that is read: HDF5 does not compare the bytes stored of a chunk with its extent, and reads beyond
 * its own memory where they are fewer. A damaged file has such chunks, and a crash would be all that a user sees. */
#ifndef DEM_OUTPUT_HDF5_CHUNKS_H
#define DEM_OUTPUT_HDF5_CHUNKS_H

#include <dem/dem.h>

#include "output/hdf5_api.h"

/** Opens a dataset to read from it, so that plain chunks are read from the file without a copy in memory: beyond its
 *  end HDF5 then fails. It must be closed by H5Dclose().
 *  \return negative if there is none */
hid_t hdf5_chunks_open(hid_t file, const char *name);

/** Checks the deflated chunks in which a block of numbers is. A dataset without filters passes.
 *  \param path,name    of the file and the dataset, for messages
 *  \param start,count  [rank] the block
 *  \return DEM_ERROR_IO naming file and dataset if a chunk holds less than its extent says, or if the rank is another;
 *          DEM_ERROR_MEMORY */
dem_status hdf5_chunks_check(const char *path, const char *name, hid_t dataset, const hsize_t *start,
                             const hsize_t *count, int rank);

/** Reads the deflated chunks in which a block of numbers is, and unpacks them to the end, where their checksum stands,
 *  a little at a time: what that gives is thrown away.
 *  \param[out] all  false: some of them are not deflated, or not there
 *  \return DEM_ERROR_IO, without a message, if one is damaged or holds less than its extent; DEM_ERROR_MEMORY */
dem_status hdf5_chunks_unpack(hid_t dataset, const hsize_t *start, const hsize_t *count, bool *all);

/** Reads what is stored of a chunk, shuffled and deflated, and unpacks that to the end, likewise.
 *  \param first      row of the dataset with which the chunk begins, if there is one of just so many rows
 *  \param[out] bytes [*size] to be freed; NULL: there is no such chunk, or it is stored in another way
 *  \return DEM_ERROR_IO, without a message, if it is damaged or holds less than its extent; DEM_ERROR_MEMORY */
dem_status hdf5_chunks_fetch(hid_t dataset, hsize_t first, hsize_t rows, unsigned char **bytes, size_t *size);

/** Reads `count` [rank] numbers in each dimension from `start` [rank] on.
 *  \return negative on failure */
herr_t hdf5_chunks_read(hid_t dataset, hid_t type, const hsize_t *start, const hsize_t *count, int rank, void *buffer);

#endif
