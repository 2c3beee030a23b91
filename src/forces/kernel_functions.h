/* SPDX-License-Identifier: BSD-3-Clause */
/* The functions of a kernel, by its instruction set. */
#ifndef DEM_FORCES_KERNEL_FUNCTIONS_H
#define DEM_FORCES_KERNEL_FUNCTIONS_H

#include "base/array_ops.h"
#include "elastic/fold_pass.h"
#include "elastic/lattice_step.h"
#include "elastic/sweep.h"

typedef struct kernel_functions {
    const char *name; /* of the key `kernel` in a deck */
    sweep_function *sweep;
    sweep_guard_function *sweep_guard;
    sweep_strain_function *sweep_strain;
    fold_pass_function *fold_pass;
    lattice_step_function *lattice_step; /* NULL: of lattice rows, by which it takes no less time */
    const array_ops *ops;
} kernel_functions;

/** Of a kind that dem_kernel_check() accepts, but for DEM_KERNEL_AUTO. */
const kernel_functions *kernel_functions_of(dem_kernel kind);

/** The fastest kind that this machine and this build have. */
dem_kernel kernel_functions_fastest(void);

#endif
