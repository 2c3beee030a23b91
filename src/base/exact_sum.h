/* SPDX-License-Identifier: BSD-3-Clause */
/* A sum of doubles that does not depend on their order: it is kept as an integer of 2176 bits in units of the smallest
 * subnormal number, 2^-1074, which has room for 2^64 terms of any size, and is rounded once, when it is read. */
#ifndef DEM_BASE_EXACT_SUM_H
#define DEM_BASE_EXACT_SUM_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/array_ops.h"

enum {
    EXACT_SUM_LIMBS = 68,
    EXACT_SUM_BLOCK = ARRAY_OPS_TERMS,
    EXACT_SUM_MOST = 1024 /* terms between two carries: each adds less than 2^52 to a limb, which has room for 2^63 */
};

/** What has been added so far; {0} is the empty sum. Terms of like size touch few limbs, and to carry, join or
 *  read the sum costs as much as these are. */
typedef struct exact_sum {
    int64_t limb[EXACT_SUM_LIMBS]; /* limb[k] is in units of 2^(32 k - 1074); its carry is taken later */
    int n_terms;                   /* since carries were taken */
    int low, high;                 /* the limbs from place `low` to before `high` may differ from 0 */
    bool has_infinity[2], has_nan; /* whether infinity, minus infinity, NAN is among the terms */
} exact_sum;

/** Takes the carries from limb to limb; the limb at `high` - 1 then has the sign of the sum. exact_sum_add() does so
 *  often enough. */
void exact_sum_carry(exact_sum *s);

/** Notes a term that is not finite. */
void exact_sum_add_special(exact_sum *s, double term);

/** Adds a term: the 53 bits of its mantissa go into two neighbouring limbs, with its sign. */
static inline void exact_sum_add(exact_sum *s, double term)
{
    uint64_t bits;
    memcpy(&bits, &term, sizeof bits);
    const int exponent = (int)(bits >> 52 & 0x7ff);
    if (exponent == 0x7ff) {
        exact_sum_add_special(s, term);
        return;
    }
    const uint64_t fraction = bits & 0xfffffffffffff, mantissa = exponent > 0 ? fraction | 1ULL << 52 : fraction;
    if (mantissa == 0) return; /* it would take the lowest limbs, and the sum all those from there on */
    const int place = exponent > 0 ? exponent - 1 : 0, shift = place % 32;
    const int64_t low = (int64_t)(mantissa << shift & 0xffffffff), high = (int64_t)(mantissa >> (32 - shift));
    const int64_t sign = bits >> 63 != 0 ? -1 : 1;
    const int at = place / 32;
    s->limb[at] += sign * low;
    s->limb[at + 1] += sign * high;
    if (at < s->low || s->high == 0) s->low = at;
    if (at + 2 > s->high) s->high = at + 2;
    if (++s->n_terms == EXACT_SUM_MOST) exact_sum_carry(s);
}

/** Adds n terms, with the same bits as one by one. For many terms whose exponents are not far apart this takes about a
 *  fifth of the instructions. */
void exact_sum_add_array(exact_sum *s, const double *terms, int64_t n);

/** The same for up to EXACT_SUM_BLOCK terms. The array must have room for a whole block; its contents are lost. */
void exact_sum_take(exact_sum *s, double terms[EXACT_SUM_BLOCK], int n);

/** Adds n/2 pairs of terms, one after another, the first of each to s[0] and the second to s[1]. */
void exact_sum_take_pairs(exact_sum s[2], double terms[EXACT_SUM_BLOCK], int n);

/** Adds the terms of another sum, which keeps them; its carries are taken. */
void exact_sum_join(exact_sum *s, exact_sum *other);

/** Makes a sum equal to another one. */
void exact_sum_copy(exact_sum *to, const exact_sum *from);

/** Empties a sum, as fast as few of its limbs are used. */
static inline void exact_sum_clear(exact_sum *s)
{
    for (int k = s->low; k < s->high; k++) s->limb[k] = 0;
    s->n_terms = s->low = s->high = 0;
    s->has_infinity[0] = s->has_infinity[1] = s->has_nan = false;
}

/** The sum of one term. */
static inline exact_sum exact_sum_of(double term)
{
    exact_sum s = {0};
    exact_sum_add(&s, term);
    return s;
}

/** How many terms the block from term `first` of n on has. */
static inline int exact_sum_block(int64_t first, int64_t n)
{
    return n - first < EXACT_SUM_BLOCK ? (int)(n - first) : EXACT_SUM_BLOCK;
}

/** The sum rounded to the nearest double, ties to even: +0 if it is 0 or empty, infinite if it overflows. If terms are
 *  not finite, it is what additions of doubles give in any order. */
double exact_sum_value(const exact_sum *s);

#endif
