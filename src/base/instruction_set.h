/* SPDX-License-Identifier: BSD-3-Clause */
/* Which vector instructions this build of the library and this machine both have. They are asked for at run time, so
 * that one build runs on all machines of an architecture. */
#ifndef DEM_BASE_INSTRUCTION_SET_H
#define DEM_BASE_INSTRUCTION_SET_H

#include <stdbool.h>

#ifdef DEM_X86_KERNELS
#define INSTRUCTION_SET_HAS(feature) (__builtin_cpu_supports(feature) != 0)
#define INSTRUCTION_SET_OF(maker)    (__builtin_cpu_is(maker) != 0)
#else
#define INSTRUCTION_SET_HAS(feature) false
#define INSTRUCTION_SET_OF(maker)    false
#endif

static inline bool instruction_set_avx2(void)
{
    return INSTRUCTION_SET_HAS("avx2");
}

static inline bool instruction_set_avx512(void)
{
    return INSTRUCTION_SET_HAS("avx512f") && INSTRUCTION_SET_HAS("avx512dq") && INSTRUCTION_SET_HAS("avx512vl");
}

/** Whether vectors of AVX-512 are divided faster than they are multiplied by an inverse from an estimate: so it is on
 *  Zen 5, and on an Intel Xeon it is not (docs/performance.md, Quotients by multiplications). */
static inline bool instruction_set_divides(void)
{
    return INSTRUCTION_SET_OF("amd");
}

#endif
