/* SPDX-License-Identifier: BSD-3-Clause */
/* Datasets of a file that stay open from one frame to the next, since HDF5 takes longer to open and close one than to
 * add a row to it. */
#ifndef DEM_OUTPUT_KEPT_DATASETS_H
#define DEM_OUTPUT_KEPT_DATASETS_H

#include "output/hdf5_api.h"

typedef struct kept_datasets kept_datasets;

/** \return NULL without memory */
kept_datasets *kept_datasets_create(void);

/** Accepts NULL.  \return negative if one of them could not be closed */
herr_t kept_datasets_close(kept_datasets *kept);

/** One that may be kept, and is then open until all are closed.
 *  \param kept  NULL: none are
 *  \return negative on failure */
hid_t kept_datasets_open(kept_datasets *kept, hid_t file, const char *name);

/** Gives back what kept_datasets_open() has opened: closes it unless it is kept.  \return negative on failure */
herr_t kept_datasets_leave(const kept_datasets *kept, hid_t dataset);

#endif
