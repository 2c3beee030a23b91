/* SPDX-License-Identifier: BSD-3-Clause */
/* The same as sweep_avx512.c, to the same bits, with divisions, for processors on which these are faster than quotients
 * by multiplications: instruction_set_divides() says where. */
#define LANES_DIVIDE
#include "elastic/lanes_avx512.h"

#define SWEEP        sweep_avx512_divider
#define SWEEP_GUARD  sweep_guard_avx512_divider
#define SWEEP_STRAIN sweep_strain_avx512_divider
#define LATTICE_STEP lattice_step_avx512_divider
#include "elastic/lattice_step_body.h"
#include "elastic/sweep_body.h"
