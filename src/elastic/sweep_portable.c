/* SPDX-License-Identifier: BSD-3-Clause */
/* The sweep with the compiler's own vectors, for any machine: the arithmetic is in sweep_body.h. */
#include "elastic/lanes_portable.h"

#define SWEEP        sweep_portable
#define SWEEP_GUARD  sweep_guard_portable
#define SWEEP_STRAIN sweep_strain_portable
#define LATTICE_STEP lattice_step_portable
#include "elastic/lattice_step_body.h"
#include "elastic/sweep_body.h"
