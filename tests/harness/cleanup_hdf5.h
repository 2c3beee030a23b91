/* SPDX-License-Identifier: BSD-3-Clause */
/* cleanup.h for HDF5's objects. */
#ifndef DEM_TEST_CLEANUP_HDF5_H
#define DEM_TEST_CLEANUP_HDF5_H

#include "output/hdf5_file.h" /* HDF5, with the functions of one version */

/** Closes a file, group, dataset, space, type, attribute or list of properties. */
static inline void free_h5(const hid_t *id)
{
    (void)H5Idec_ref(*id);
}

#endif
