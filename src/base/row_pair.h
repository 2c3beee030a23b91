/* SPDX-License-Identifier: BSD-3-Clause */
/* Two components of a row at once, in C with the compiler's own vectors of two numbers: the first two, or the third
 * beside a zero. Every operation rounds as it does for each number alone. */
#ifndef DEM_BASE_ROW_PAIR_H
#define DEM_BASE_ROW_PAIR_H

#include <math.h>
#include <stdint.h>

#include "base/inline.h"

typedef double row_pair __attribute__((vector_size(16)));
typedef int64_t row_pair_bits __attribute__((vector_size(16)));

/** Components d and d + 1 of a row; from the third on there is one. */
INLINE row_pair row_pair_at(const double *row, int d)
{
    return d < 2 ? (row_pair){row[d], row[d + 1]} : (row_pair){row[d], 0.0};
}

/** Both components of a row that begins at a multiple of 16 bytes, as malloc() aligns memory. */
INLINE row_pair row_pair_aligned(const double *row)
{
    return *(const row_pair *)row;
}

INLINE void row_pair_put(double *row, int d, row_pair a)
{
    row[d] = a[0];
    if (d < 2) row[d + 1] = a[1];
}

INLINE row_pair row_pair_absolute(row_pair a)
{
    const row_pair_bits all_but_sign = {INT64_MAX, INT64_MAX};
    return (row_pair)((row_pair_bits)a & all_but_sign);
}

/** A sum, and the squares of both added to it one after the other. */
INLINE double row_pair_add_squares(double sum, row_pair a)
{
    const row_pair squares = a * a;
    return sum + squares[0] + squares[1];
}

INLINE row_pair row_pair_sqrt(row_pair a)
{
    double root[2];
    for (int q = 0; q < 2; q++) root[q] = sqrt(a[q]);
    return (row_pair){root[0], root[1]};
}

/** The lengths of two vectors. */
INLINE row_pair row_pair_lengths(row_pair one, row_pair two)
{
    const row_pair x = {one[0], two[0]}, y = {one[1], two[1]};
    return row_pair_sqrt(x * x + y * y);
}

#endif
