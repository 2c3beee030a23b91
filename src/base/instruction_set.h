/* SPDX-License-Identifier: BSD-3-Clause */
/* Which sets of vector instructions there are in this build of the library and on this machine. */
#ifndef DEM_BASE_INSTRUCTION_SET_H
#define DEM_BASE_INSTRUCTION_SET_H

#include <stdbool.h>

#ifdef DEM_X86_KERNELS
#define INSTRUCTION_SET_HAS(feature) (__builtin_cpu_supports(feature) != 0)
#else
#define INSTRUCTION_SET_HAS(feature) false
#endif

static inline bool instruction_set_avx2(void)
{
    return INSTRUCTION_SET_HAS("avx2");
}

static inline bool instruction_set_avx512(void)
{
    return INSTRUCTION_SET_HAS("avx512f") && INSTRUCTION_SET_HAS("avx512dq") && INSTRUCTION_SET_HAS("avx512vl");
}

#endif
