/* SPDX-License-Identifier: BSD-3-Clause */
/* A superaccumulator: the sum is an integer of 68 limbs of 32 bits in units of 2^-1074, wide enough for every double,
 * so that no addition rounds and the order of the terms does not matter (docs/algorithms.md, Exact sums).
 * This file has the carries between limbs, a fast path for many terms, and the one rounding at the end. The addition of
 * a single term is inline in exact_sum.h; the splitting of terms in vectors is in array_ops.c. Sums over several
 * processes do not belong here but in reduce.h. */
#include "base/exact_sum.h"

#include <math.h>
#include <stdlib.h>

enum {
    limb_bits = 32,
    mantissa_bits = 53,
    unit_exponent = -1074 /* of 2 */
};

static const int64_t limb_size = 0x100000000, limb_mask = 0xffffffff;

/* Moves what exceeds 32 bits from each limb to the next one. A limb may be negative before: the mask takes it modulo
 * 2^32, and the exact division makes the carry negative. Afterwards every limb but the last that is used is in
 * [0, 2^32), and the last has the sign of the sum; it has no more than 32 bits either, unless there is none behind. */
void exact_sum_carry(exact_sum *s)
{
    int64_t carry = 0;
    for (int k = s->low; k < s->high; k++) {
        const int64_t here = s->limb[k] + carry;
        const bool fits = k == EXACT_SUM_LIMBS - 1 || llabs(here) <= limb_mask;
        const bool is_last = k == s->high - 1;
        if (is_last && !fits) s->high++;
        s->limb[k] = is_last && fits ? here : here & limb_mask;
        carry = (here - s->limb[k]) / limb_size;
    }
    s->n_terms = 0;
}

/* Both take their carries first, so that each limb has room for the other's. */
void exact_sum_join(exact_sum *s, exact_sum *other)
{
    exact_sum_carry(s);
    exact_sum_carry(other);
    for (int k = other->low; k < other->high; k++) s->limb[k] += other->limb[k];
    if (other->high > 0 && (s->high == 0 || other->low < s->low)) s->low = other->low;
    if (other->high > s->high) s->high = other->high;
    s->n_terms = 1;
    for (int k = 0; k < 2; k++) s->has_infinity[k] = s->has_infinity[k] || other->has_infinity[k];
    s->has_nan = s->has_nan || other->has_nan;
}

/* Only limbs that are used are touched, for lists of sums of which most are empty. */
void exact_sum_copy(exact_sum *to, const exact_sum *from)
{
    for (int k = to->low; k < to->high; k++) to->limb[k] = 0;
    for (int k = from->low; k < from->high; k++) to->limb[k] = from->limb[k];
    to->n_terms = from->n_terms;
    to->low = from->low;
    to->high = from->high;
    to->has_infinity[0] = from->has_infinity[0];
    to->has_infinity[1] = from->has_infinity[1];
    to->has_nan = from->has_nan;
}

/* Terms that are not finite are only noted. exact_sum_value() combines them as additions of doubles would. */
void exact_sum_add_special(exact_sum *s, double term)
{
    if (isnan(term))
        s->has_nan = true;
    else
        s->has_infinity[term < 0.0] = true;
}

/* ---- many terms ---- */

/* Adds what is left of terms one by one. */
static void take_each(exact_sum *even, exact_sum *odd, const double *terms, int n)
{
    for (int k = 0; k < n; k++) exact_sum_add(k % 2 == 0 ? even : odd, terms[k]);
}

typedef struct term_sizes {
    double size[2]; /* bounds for the sums of the terms at even and at odd places */
} term_sizes;

static term_sizes sizes_of(const array_ops *ops, const double *terms, int n, bool together)
{
    term_sizes s;
    ops->magnitude(s.size, terms, n);
    if (together) s.size[0] = s.size[1] = s.size[0] + s.size[1];
    return s;
}

/* Adds a block of terms. Each round splits leading parts off all terms at once (split() in array_ops.c) and adds these
 * few numbers to the accumulator instead of n. The sizes bound what is left of the terms and fall by a factor of 2^85
 * or more in a round: usual terms take one or two rounds, terms as far apart as doubles can be some twenty. The loop
 * ends when nothing is left. Terms too large for the splitting, or not finite, are added one by one. Those at even
 * places and those at odd ones are of two sums, or of one. */
static inline void take(exact_sum *even, exact_sum *odd, double terms[EXACT_SUM_BLOCK], int n)
{
    const array_ops *ops = array_ops_fastest();
    while (n % ARRAY_OPS_LANES != 0) terms[n++] = 0.0;
    double parts[4];
    term_sizes of = sizes_of(ops, terms, n, even == odd);
    bool left = of.size[0] + of.size[1] != 0.0;
    while (left && of.size[0] + of.size[1] <= ARRAY_OPS_LARGEST_SIZE) {
        left = ops->split(parts, terms, n, of.size);
        for (int k = 0; k < 4; k += 2) {
            exact_sum_add(even, even == odd ? parts[k] + parts[k + 1] : parts[k]);
            if (even != odd) exact_sum_add(odd, parts[k + 1]);
        }
        if (left) of = sizes_of(ops, terms, n, even == odd);
    }
    if (left) take_each(even, odd, terms, n);
}

void exact_sum_take(exact_sum *s, double terms[EXACT_SUM_BLOCK], int n)
{
    take(s, s, terms, n);
}

void exact_sum_take_pairs(exact_sum s[2], double terms[EXACT_SUM_BLOCK], int n)
{
    take(&s[0], &s[1], terms, n);
}

/* The terms are copied block by block, because exact_sum_take() destroys what it is given. */
void exact_sum_add_array(exact_sum *s, const double *terms, int64_t n)
{
    double block[EXACT_SUM_BLOCK];
    for (int64_t k = 0; k < n; k += EXACT_SUM_BLOCK) {
        const int here = exact_sum_block(k, n);
        memcpy(block, terms + k, (size_t)here * sizeof *block);
        exact_sum_take(s, block, here);
    }
}

/* ---- rounding, of limbs after a carry and not negative ---- */

/* Number of bits up to the highest that is set; 0 for a sum of 0. */
static int length_of(const exact_sum *s)
{
    int k = s->high - 1, length = 0;
    while (k > s->low && s->limb[k] == 0) k--;
    for (int64_t rest = s->limb[k]; rest > 0; rest >>= 1) length++;
    return limb_bits * k + length;
}

/* The bit with the value 2^(place - 1074). */
static int64_t bit_at(const exact_sum *s, int place)
{
    return s->limb[place / limb_bits] >> place % limb_bits & 1;
}

/* The 53 bits from place `low` on. They lie in two neighbouring limbs, or in three; a shift by 32 is done in two parts,
 * since `shift` may be 0. */
static int64_t mantissa_at(const exact_sum *s, int low)
{
    const int64_t *limb = &s->limb[low / limb_bits];
    const int shift = low % limb_bits;
    const uint64_t bits = (uint64_t)limb[0] >> shift | (uint64_t)limb[1] << (limb_bits - shift) |
                          (uint64_t)limb[2] << limb_bits << (limb_bits - shift);
    return (int64_t)(bits & (((uint64_t)1 << mantissa_bits) - 1));
}

/* Whether a bit below `place` is set: decides between a tie and more than half a unit. */
static bool any_below(const exact_sum *s, int place)
{
    const int whole = place / limb_bits;
    for (int k = s->low; k < whole; k++)
        if (s->limb[k] != 0) return true;
    return (s->limb[whole] & (((int64_t)1 << place % limb_bits) - 1)) != 0;
}

/* Rounds to nearest, ties to even: the mantissa is incremented if the first bit dropped is set and either the mantissa
 * is odd or a lower bit is set as well. A mantissa that becomes 2^53 is still exact in a double. ldexp() scales without
 * a further rounding, because a sum of at most 53 bits is taken whole (low = 0) and a longer one is a normal number. */
static double magnitude(const exact_sum *s)
{
    const int length = length_of(s), low = length > mantissa_bits ? length - mantissa_bits : 0;
    int64_t mantissa = mantissa_at(s, low);
    if (low > 0 && bit_at(s, low - 1) && (mantissa & 1 || any_below(s, low - 1))) mantissa++;
    return ldexp((double)mantissa, low + unit_exponent);
}

/* The accumulator is copied, since reading a sum must not change it. A negative sum has all limbs negated and is
 * carried again, so that the rounding sees a magnitude: rounding to nearest is symmetric. */
double exact_sum_value(const exact_sum *s)
{
    if (s->has_nan || (s->has_infinity[0] && s->has_infinity[1])) return (double)NAN;
    if (s->has_infinity[0] || s->has_infinity[1]) return s->has_infinity[0] ? (double)INFINITY : -(double)INFINITY;
    if (s->high == 0) return 0.0;
    exact_sum rest = *s;
    exact_sum_carry(&rest);
    const bool negative = rest.limb[rest.high - 1] < 0;
    for (int k = rest.low; negative && k < rest.high; k++) rest.limb[k] = -rest.limb[k];
    if (negative) exact_sum_carry(&rest);
    return negative ? -magnitude(&rest) : magnitude(&rest);
}
