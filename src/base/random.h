/* SPDX-License-Identifier: BSD-3-Clause */
/* Pseudo-random numbers that are the same on every machine: integer arithmetic and one exact division. Used where a
 * seed has to give the same result everywhere, as in jitter, strengths and start vectors of iterations. */
#ifndef DEM_BASE_RANDOM_H
#define DEM_BASE_RANDOM_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static const uint64_t random_stride = 0x9e3779b97f4a7c15u;

/** What splitmix64 makes of its state: every bit of it changes about half of the bits. */
static inline uint64_t random_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/** A hash that goes on with an array: with numbers of 8 bytes, and what is left of bytes; NULL is another array than an
 *  empty one. */
static inline uint64_t random_hash(uint64_t hash, const void *array, size_t size)
{
    uint64_t word;
    if (array == NULL) return random_mix(hash);
    for (size_t k = 0; k < size; k += sizeof word) {
        word = 0;
        memcpy(&word, (const char *)array + k, size - k < sizeof word ? size - k : sizeof word);
        hash = random_mix(hash + random_stride + word);
    }
    return hash;
}

/** The next number, in [-1, 1), of splitmix64. The state may start at any value and is advanced. */
static inline double random_next(uint64_t *state)
{
    return (double)(int64_t)random_mix(*state += random_stride) / 9223372036854775808.0;
}

/** A state for random_next() that belongs to number k of a stream of a seed: who draws how many numbers depends on no
 *  order. */
static inline uint64_t random_state_of(uint64_t seed, uint64_t stream, uint64_t k)
{
    const uint64_t of_seed = random_mix(seed + random_stride);
    return random_mix((of_seed ^ stream) + random_stride) ^ k;
}

/** Number k of a stream of a seed, in (0, 1), without those before it: who draws which number depends on no order. Of
 *  52 bits, so that neither 0 nor 1 comes out. */
static inline double random_at(uint64_t seed, uint64_t stream, uint64_t k)
{
    const uint64_t state = random_state_of(seed, stream, k);
    return ((double)(random_mix(state + random_stride) >> 12) + 0.5) / 4503599627370496.0;
}

#endif
