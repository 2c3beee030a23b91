/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic/lanes_avx512.h"

#define SWEEP       sweep_avx512
#define SWEEP_GUARD sweep_guard_avx512
#include "elastic/sweep_body.h"
