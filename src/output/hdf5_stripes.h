/* SPDX-License-Identifier: BSD-3-Clause */
/* Virtual datasets: rows that stand in other files. A dataset has the same number of rows for each frame, and of these
 * each other file has a range, the *stripe*, of all frames one behind the other. HDF5 puts them together when they are
 * read, whoever reads. */
#ifndef DEM_OUTPUT_HDF5_STRIPES_H
#define DEM_OUTPUT_HDF5_STRIPES_H

#include <stdbool.h>

#include <dem/dem.h>

#include "output/hdf5_api.h"

enum { HDF5_STRIPES_NAME = 280 };

/** Blocks of rows of a dataset, which are the first rows of the dataset of the same name in another file. */
typedef struct hdf5_stripe {
    char file[HDF5_STRIPES_NAME]; /**< in the folder of the file of the dataset */
    hsize_t first, stride;        /**< row at which the first block begins, and from there on each further one */
    hsize_t n, rows;              /**< blocks, and rows of each */
    bool grows;                   /**< there are as many blocks as the other file has, whatever n */
} hdf5_stripe;

/** A new virtual dataset without stripes, to be created with. In place of what cannot be found there are NaN, -1 or
 *  255.
 *  \return negative on failure */
hid_t hdf5_stripes_layout(hid_t type);

/** Adds a stripe to a layout.
 *  \param name    of the dataset
 *  \param extent  [HDF5_MAX_RANK] of the virtual dataset
 *  \return negative on failure */
herr_t hdf5_stripes_add(hid_t layout, const char *name, const hsize_t *extent, int rank, const hdf5_stripe *stripe);

/** How many stripes a dataset has; 0: it is not virtual. */
int hdf5_stripes_count(hid_t dataset);

/** Whether all stripes are such as hdf5_stripes_add() makes, in files in the same folder: before that is known, HDF5
 *  must not be asked for the extent, for which it opens the files of stripes that grow. */
bool hdf5_stripes_are_beside(hid_t dataset, const char *name);

/** The stripes of a dataset, to be freed; of those that grow, n is how many blocks the dataset has now. HDF5 may keep
 *  their files open until the dataset is closed: nobody else opens them before.
 *  \return DEM_ERROR_IO, without a message, if one is not as hdf5_stripes_are_beside() asks for; DEM_ERROR_MEMORY */
dem_status hdf5_stripes_list(hid_t dataset, const char *name, hdf5_stripe **list, int *n);

#endif
