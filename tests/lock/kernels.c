/* SPDX-License-Identifier: BSD-3-Clause */
/* See kernels.h. */
#include "kernels.h"

#include "store.h"
#include "unit/close.h"

void kernels_check(const char *name, uint64_t (*run)(const void *what, dem_kernel kernel), const void *what)
{
    const uint64_t portable = run(what, DEM_KERNEL_PORTABLE);
    for (dem_kernel k = DEM_KERNEL_AVX2; k <= DEM_KERNEL_AVX512; k++) {
        if (dem_kernel_check(k) != DEM_OK) continue;
        const uint64_t hash = run(what, k);
        if (hash != portable) store_disagree(name, dem_kernel_name(k), hash);
    }
    store_check(name, portable);
}

void kernels_tell(void)
{
    for (dem_kernel k = DEM_KERNEL_AVX2; k <= DEM_KERNEL_AVX512; k++)
        if (dem_kernel_check(k) != DEM_OK)
            print_message("# without the kernel %s: %s\n", dem_kernel_name(k), dem_status_message());
}
