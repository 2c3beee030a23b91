/* SPDX-License-Identifier: BSD-3-Clause */
/* Arithmetic on whole arrays, compiled once for each instruction set, with the same bits in all of them. array_ops.c
 * says why. Loops over the nodes of a lattice do not belong here but in elastic/ and forces/. */
#ifndef DEM_BASE_ARRAY_OPS_H
#define DEM_BASE_ARRAY_OPS_H

#include <dem/dem.h>

#include "base/instruction_set.h"

/** A sum of squares that does not depend on their order: each is rounded to 2^-60 and added as an integer. */
typedef struct array_ops_sum {
    int64_t high, low; /* in units of 2^-20 and 2^-60, 0 <= low < 2^40 */
    double largest;    /* square; NAN if a square is NAN. The sum is valid if this is <= ARRAY_OPS_LARGEST */
} array_ops_sum;

#define ARRAY_OPS_LARGEST 1024.0

enum { ARRAY_OPS_LANES = 16, ARRAY_OPS_TERMS = 512 };
#define ARRAY_OPS_LARGEST_SIZE 0x1p1018

typedef struct array_ops {
    /** out = sum of c_k in_k over k = 0 to n - 1, n >= 1, in this order. `out` must not be one of the operands. */
    void (*combine)(double *out, int n, const double *c, const double *const *in, dem_index size);
    /** Adds the squares of scale x[k] w[k] to the sum. */
    void (*square)(array_ops_sum *sum, const double *x, const double *w, double scale, dem_index size);
    /** A step h of Verlet, (5), from start = {x0, v0, a0}: x1, and v1 extrapolated with the acceleration a0. */
    void (*drift)(double *x1, double *v1, const double *const start[3], double h, dem_index size);
    /** v1 += h/2 (a1 - a0) */
    void (*kick)(double *v1, const double *a0, const double *a1, double h, dem_index size);
    /** Replaces n squared lengths by strains: (length - reference)/reference. */
    void (*stretch)(double *lengths, const double *reference, int n);
    /** Sums of |terms| at even and at odd places; n is a multiple of ARRAY_OPS_LANES. NAN or infinite if a term is. */
    void (*magnitude)(double size[2], const double *terms, int n);
    /** Splits n terms without an error into four parts and remainders: the sum of the terms at even places is parts[0]
     *  + parts[2] + the sum of their remainders, that of the others has parts[1] and parts[3]. A remainder is below
     *  2^-94 of its size.
     *  \param terms  become remainders, if any of these is not 0
     *  \param n      a multiple of ARRAY_OPS_LANES, at most ARRAY_OPS_TERMS
     *  \param size   what magnitude() has given or more, at most ARRAY_OPS_LARGEST_SIZE. If both are the sum of that,
     *                parts[0] + parts[1] is exact, and so is parts[2] + parts[3].
     *  \return whether any remainder is not 0 */
    bool (*split)(double parts[4], double *terms, int n, const double size[2]);
} array_ops;

#ifdef DEM_X86_KERNELS
extern const array_ops array_ops_portable, array_ops_avx2, array_ops_avx512;
#else
extern const array_ops array_ops_portable;
#define array_ops_avx2   array_ops_portable
#define array_ops_avx512 array_ops_portable
#endif

/** The fastest table that this machine has, for callers to whom no kernel is given. */
static inline const array_ops *array_ops_fastest(void)
{
    if (instruction_set_avx512()) return &array_ops_avx512;
    return instruction_set_avx2() ? &array_ops_avx2 : &array_ops_portable;
}

/** Adds one sum to another: `low` takes its carry to `high`, so that the same total has the same bits. */
static inline void array_ops_add(array_ops_sum *sum, const array_ops_sum *other)
{
    const int64_t low = sum->low + other->low, carry = (low - (low & 0xffffffffff)) / 0x10000000000;
    sum->high += other->high + carry;
    sum->low = low & 0xffffffffff;
    if (!(other->largest <= sum->largest) && sum->largest == sum->largest) sum->largest = other->largest;
}

/* The sum as a double, rounded. */
static inline double array_ops_value(const array_ops_sum *sum)
{
    return (double)sum->high * 0x1p-20 + (double)sum->low * 0x1p-60;
}

#endif
