/* SPDX-License-Identifier: BSD-3-Clause */
/* A fuzzer's bytes as a source of choices and numbers. Where they have run out, everything is 0. */
#ifndef DEM_FUZZ_BYTES_H
#define DEM_FUZZ_BYTES_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct bytes {
    const uint8_t *at;
    size_t left;
} bytes;

static inline void bytes_copy(bytes *from, void *to, size_t size)
{
    const size_t n = size < from->left ? size : from->left;
    memset(to, 0, size);
    if (n > 0) memcpy(to, from->at, n);
    from->at += n;
    from->left -= n;
}

static inline unsigned bytes_take(bytes *from)
{
    uint8_t byte;
    bytes_copy(from, &byte, 1);
    return byte;
}

/** 0 to n - 1, n at most 256. */
static inline unsigned bytes_below(bytes *from, unsigned n)
{
    return bytes_take(from) % n;
}

/** low to high, the middle one of 65536 steps first. */
static inline double bytes_between(bytes *from, double low, double high)
{
    int16_t step;
    bytes_copy(from, &step, sizeof step);
    return low + (high - low) * ((double)step + 32768.0) / 65535.0;
}

/** Any number there is. */
static inline double bytes_real(bytes *from)
{
    double number;
    bytes_copy(from, &number, sizeof number);
    return number;
}

/** What a target demands of the library: a fuzzer takes an abort for a finding. */
#define require(expression)                                                                                            \
    do {                                                                                                               \
        if (!(expression)) {                                                                                           \
            (void)fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #expression);                       \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

#endif
