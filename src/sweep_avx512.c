/* SPDX-License-Identifier: BSD-3-Clause */
#include "lanes_avx512.h"

#define SWEEP sweep_avx512
#include "sweep_body.h"
