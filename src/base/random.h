/* SPDX-License-Identifier: BSD-3-Clause */
/* Pseudo-random numbers that are the same on every machine: integer arithmetic and one exact division. Used where a
 * seed has to give the same result everywhere, as in jitter and start vectors of iterations. */
#ifndef DEM_BASE_RANDOM_H
#define DEM_BASE_RANDOM_H

#include <stdint.h>

/** The next number, in [-1, 1), of splitmix64. The state may start at any value and is advanced. */
static inline double random_next(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)(int64_t)(z ^ (z >> 31)) / 9223372036854775808.0;
}

#endif
