/* SPDX-License-Identifier: BSD-3-Clause */
/* The sweep with AVX-512: the file defines the vectors, and sweep_body.h has the arithmetic. It must be called only
 * where instruction_set_avx512() says so. */
#include "elastic/lanes_avx512.h"

#define SWEEP        sweep_avx512
#define SWEEP_GUARD  sweep_guard_avx512
#define SWEEP_STRAIN sweep_strain_avx512
#include "elastic/sweep_body.h"
