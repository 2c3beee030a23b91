/* SPDX-License-Identifier: BSD-3-Clause */
/* One case, run with every kernel that the machine has: they must agree, so that one hash is stored. */
#ifndef DEM_TEST_KERNELS_H
#define DEM_TEST_KERNELS_H

#include <stdint.h>

#include <dem/dem.h>

/** \param run  the hash of the case with a kernel */
void kernels_check(const char *name, uint64_t (*run)(const void *what, dem_kernel kernel), const void *what);

/** Tells which kernels are left out here. */
void kernels_tell(void);

#endif
