/* SPDX-License-Identifier: BSD-3-Clause */
/* Arithmetic on whole arrays, once for each instruction set, to the same bits. */
#ifndef DEM_BASE_ARRAY_OPS_H
#define DEM_BASE_ARRAY_OPS_H

#include <dem/dem.h>

#include "base/instruction_set.h"

/** A sum of squares that does not depend on their order: each is rounded to 2^-60 and added as an integer. */
typedef struct array_ops_sum {
    int64_t high, low; /* in units of 2^-20 and 2^-60, 0 <= low < 2^40 */
    double largest;    /* of the squares, NAN if one is none; the sum holds where it is <= ARRAY_OPS_LARGEST */
} array_ops_sum;

#define ARRAY_OPS_LARGEST 1024.0

enum { ARRAY_OPS_LANES = 16, ARRAY_OPS_TERMS = 256 };
#define ARRAY_OPS_LARGEST_SIZE 0x1p1018

typedef struct array_ops {
    /** out = sum of c_k in_k, from k = 0 on; out is none of them, n >= 1. */
    void (*combine)(double *out, int n, const double *c, const double *const *in, dem_index size);
    /** Adds (scale x w)^2 to the sum. */
    void (*square)(array_ops_sum *sum, const double *x, const double *w, double scale, dem_index size);
    /** A step h of Verlet from (x0, v0) with accelerations a0: x1, and v1 extrapolated. */
    void (*drift)(double *x1, double *v1, const double *const start[3], double h, dem_index size);
    /** v1 += h/2 (a1 - a0) */
    void (*kick)(double *v1, const double *a0, const double *a1, double h, dem_index size);
    /** In place of n squared lengths: how far each length is off its reference, in units of that. */
    void (*stretch)(double *lengths, const double *reference, int n);
    /** Sum of the magnitudes of n terms, a multiple of ARRAY_OPS_LANES; NAN or infinite if one of them is that. */
    double (*magnitude)(const double *terms, int n);
    /** Splits n terms, a multiple of ARRAY_OPS_LANES and at most ARRAY_OPS_TERMS, without an error: their sum is that
     *  of both parts and of what is left in their place, which is below 2^-94 of `size` for each. `size`, at most
     *  ARRAY_OPS_LARGEST_SIZE, is their magnitude.  \return the magnitude of what is left */
    double (*split)(double parts[2], double *terms, int n, double size);
} array_ops;

#ifdef DEM_X86_KERNELS
extern const array_ops array_ops_portable, array_ops_avx2, array_ops_avx512;
#else
extern const array_ops array_ops_portable;
#define array_ops_avx2   array_ops_portable
#define array_ops_avx512 array_ops_portable
#endif

/** The table for this machine, where any will do. */
static inline const array_ops *array_ops_fastest(void)
{
    if (instruction_set_avx512()) return &array_ops_avx512;
    return instruction_set_avx2() ? &array_ops_avx2 : &array_ops_portable;
}

/** Adds one sum to another. */
static inline void array_ops_add(array_ops_sum *sum, const array_ops_sum *other)
{
    const int64_t low = sum->low + other->low, carry = (low - (low & 0xffffffffff)) / 0x10000000000;
    sum->high += other->high + carry;
    sum->low = low & 0xffffffffff;
    if (!(other->largest <= sum->largest) && sum->largest == sum->largest) sum->largest = other->largest;
}

static inline double array_ops_value(const array_ops_sum *sum)
{
    return (double)sum->high * 0x1p-20 + (double)sum->low * 0x1p-60;
}

#endif
