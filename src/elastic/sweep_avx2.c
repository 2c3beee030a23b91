/* SPDX-License-Identifier: BSD-3-Clause */
/* The sweep with AVX2: the file defines the vectors, and sweep_body.h has the arithmetic. Compiled with -mavx2, so it
 * must be called only where instruction_set_avx2() says so. */
#include "elastic/lanes_avx2.h"

#define SWEEP        sweep_avx2
#define SWEEP_GUARD  sweep_guard_avx2
#define SWEEP_STRAIN sweep_strain_avx2
#include "elastic/sweep_body.h"
