/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions that are always compiled into their callers, and loops of which every round is written out: so constants
 * among their arguments are known, and vectors stay in registers. Compilers do neither where they find a function too
 * large, and then a sweep takes many times as long. And conditions that nearly always hold, so that what follows where
 * they do not is compiled apart. */
#ifndef DEM_BASE_INLINE_H
#define DEM_BASE_INLINE_H

/* Where nothing is optimized it would gain nothing, and sweeps take ten times as long to compile. */
#ifdef __OPTIMIZE__
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

/** Before a loop of at most eight rounds, whose number the compiler knows. */
#define UNROLLED _Pragma("GCC unroll 8")

#define USUALLY(condition) __builtin_expect((condition), 1)

#endif
