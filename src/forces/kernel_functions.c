/* SPDX-License-Identifier: BSD-3-Clause */
/* Which kernels there are: names and functions of each instruction set, and whether the machine has it. */
#include "forces/kernel_functions.h"

#include <string.h>

#include "base/instruction_set.h"
#include "base/status.h"

#ifndef DEM_X86_KERNELS
#define sweep_avx2                  sweep_portable
#define sweep_avx512                sweep_portable
#define sweep_avx512_divider        sweep_portable
#define sweep_guard_avx2            sweep_guard_portable
#define sweep_guard_avx512          sweep_guard_portable
#define sweep_guard_avx512_divider  sweep_guard_portable
#define sweep_strain_avx2           sweep_strain_portable
#define sweep_strain_avx512         sweep_strain_portable
#define sweep_strain_avx512_divider sweep_strain_portable
#define fold_pass_avx2              fold_pass_portable
#define fold_pass_avx512            fold_pass_portable
#define lattice_step_avx512_divider lattice_step_portable
#endif

/* By dem_kernel. A build without the instruction sets of x86 has the portable functions in their place. */
static const kernel_functions rows[] = {
    [DEM_KERNEL_AUTO] = {"auto", NULL, NULL, NULL, NULL, NULL, NULL},
    [DEM_KERNEL_PORTABLE] = {"portable", sweep_portable, sweep_guard_portable, sweep_strain_portable,
                             fold_pass_portable, lattice_step_portable, &array_ops_portable},
    [DEM_KERNEL_AVX2] = {"avx2", sweep_avx2, sweep_guard_avx2, sweep_strain_avx2, fold_pass_avx2, NULL,
                         &array_ops_avx2},
    [DEM_KERNEL_AVX512] = {"avx512", sweep_avx512, sweep_guard_avx512, sweep_strain_avx512, fold_pass_avx512, NULL,
                           &array_ops_avx512},
};
static const kernel_functions avx512_divider = {
    "avx512",         sweep_avx512_divider,        sweep_guard_avx512_divider, sweep_strain_avx512_divider,
    fold_pass_avx512, lattice_step_avx512_divider, &array_ops_avx512};
enum { n_rows = sizeof rows / sizeof rows[0] };

/* Whether this machine and this build have the instruction set. */
static bool runs_here(dem_kernel kind)
{
    if (kind == DEM_KERNEL_AVX2) return instruction_set_avx2();
    if (kind == DEM_KERNEL_AVX512) return instruction_set_avx512();
    return kind == DEM_KERNEL_PORTABLE;
}

/* The kinds are numbered by speed, and the portable one runs everywhere. */
dem_kernel kernel_functions_fastest(void)
{
    dem_kernel kind = DEM_KERNEL_AVX512;
    while (!runs_here(kind)) kind--;
    return kind;
}

/* Names are those of the key `kernel` in a deck; "auto" is one of them. */
dem_status dem_kernel_find(dem_kernel *out, const char *name)
{
    CHECK(out != NULL && name != NULL, DEM_ERROR_ARGUMENT, "dem_kernel_find: %s is NULL", out == NULL ? "out" : "name");
    for (int k = 0; k < n_rows; k++)
        if (strcmp(rows[k].name, name) == 0) {
            *out = (dem_kernel)k;
            return DEM_OK;
        }
    return status_fail(DEM_ERROR_ARGUMENT, "no kernel is called '%s'", name);
}

const char *dem_kernel_name(dem_kernel kind)
{
    return (int)kind >= 0 && (int)kind < n_rows ? rows[kind].name : NULL;
}

dem_status dem_kernel_check(dem_kernel kind)
{
    CHECK(dem_kernel_name(kind) != NULL, DEM_ERROR_ARGUMENT, "unknown kernel %d", (int)kind);
    CHECK(kind == DEM_KERNEL_AUTO || runs_here(kind), DEM_ERROR_ARGUMENT,
          "this machine, or this build of the library, does not have the kernel '%s'", rows[kind].name);
    return DEM_OK;
}

const kernel_functions *kernel_functions_of(dem_kernel kind)
{
    return kind == DEM_KERNEL_AVX512 && instruction_set_divides() ? &avx512_divider : &rows[kind];
}
