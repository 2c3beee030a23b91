/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of the components of vectors and tensors. */
#ifndef DEM_LABEL_H
#define DEM_LABEL_H

#include <dem/dem.h>

/** "", "x", "yy", "1", ...: what the k-th of n components of an array of this name is called. */
const char *label_component(const char *name, dem_index k, dem_index n);

#endif
