/* SPDX-License-Identifier: BSD-3-Clause */
/* For tests of steps that are taken at once in bodies of any size. */
#ifndef DEM_TEST_KERNEL_OF_ROWS_H
#define DEM_TEST_KERNEL_OF_ROWS_H

#include "forces/kernel_functions.h"

/** The fastest kernel that steps by lattice rows. Not all do: that of AVX-512 by multiplications takes blocks. */
static inline dem_kernel kernel_of_rows(void)
{
    const dem_kernel fastest = kernel_functions_fastest();
    return kernel_functions_of(fastest)->lattice_step != NULL ? fastest : DEM_KERNEL_PORTABLE;
}

#endif
