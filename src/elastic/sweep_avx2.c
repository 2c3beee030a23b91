/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic/lanes_avx2.h"

#define SWEEP       sweep_avx2
#define SWEEP_GUARD sweep_guard_avx2
#include "elastic/sweep_body.h"
