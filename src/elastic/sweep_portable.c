/* SPDX-License-Identifier: BSD-3-Clause */
#include "elastic/lanes_portable.h"

#define SWEEP       sweep_portable
#define SWEEP_GUARD sweep_guard_portable
#include "elastic/sweep_body.h"
