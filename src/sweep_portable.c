/* SPDX-License-Identifier: BSD-3-Clause */
#include "lanes_portable.h"

#define SWEEP       sweep_portable
#define SWEEP_GUARD sweep_guard_portable
#include "sweep_body.h"
