/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions of HDF5, of version 1.10 whatever the version installed. */
#ifndef DEM_OUTPUT_HDF5_API_H
#define DEM_OUTPUT_HDF5_API_H

#define H5_USE_110_API
#include <hdf5.h>

/** Extents of a dataset, of ours at most. */
enum { HDF5_MAX_RANK = 3 };

#endif
