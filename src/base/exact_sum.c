/* SPDX-License-Identifier: BSD-3-Clause */
/* Carries, sums of many terms, and the one rounding. */
#include "base/exact_sum.h"

#include <math.h>

enum {
    limb_bits = 32,
    mantissa_bits = 53,
    unit_exponent = -1074 /* of 2 */
};

static const int64_t limb_size = 0x100000000, limb_mask = 0xffffffff;

/* Afterwards every limb but the last is in [0, 2^32), and the last has the sign of the sum. */
void exact_sum_carry(exact_sum *s)
{
    int64_t carry = 0;
    for (int k = 0; k < EXACT_SUM_LIMBS - 1; k++) {
        const int64_t here = s->limb[k] + carry;
        s->limb[k] = here & limb_mask;
        carry = (here - s->limb[k]) / limb_size;
    }
    s->limb[EXACT_SUM_LIMBS - 1] += carry;
    s->n_terms = 0;
}

void exact_sum_add_special(exact_sum *s, double term)
{
    if (isnan(term))
        s->has_nan = true;
    else
        s->has_infinity[term < 0.0] = true;
}

/* ---- many terms ---- */

/* Usual terms are split once or twice, those as far apart as doubles can be some twenty times. */
void exact_sum_take(exact_sum *s, double terms[EXACT_SUM_BLOCK], int n)
{
    const array_ops *ops = array_ops_fastest();
    while (n % ARRAY_OPS_LANES != 0) terms[n++] = 0.0;
    double size = ops->magnitude(terms, n), parts[2];
    while (size > 0.0 && size <= ARRAY_OPS_LARGEST_SIZE) {
        size = ops->split(parts, terms, n, size);
        exact_sum_add(s, parts[0]);
        exact_sum_add(s, parts[1]);
    }
    for (int k = 0; k < n && size != 0.0; k++) exact_sum_add(s, terms[k]);
}

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

/* Number of bits up to the highest that is set. */
static int length_of(const exact_sum *s)
{
    int k = EXACT_SUM_LIMBS - 1, length = 0;
    while (k > 0 && s->limb[k] == 0) k--;
    for (int64_t rest = s->limb[k]; rest > 0; rest >>= 1) length++;
    return limb_bits * k + length;
}

static int64_t bit_at(const exact_sum *s, int place)
{
    return s->limb[place / limb_bits] >> place % limb_bits & 1;
}

/* The bits from `low` on, as many as a mantissa has: of two limbs, or of three. */
static int64_t mantissa_at(const exact_sum *s, int low)
{
    const int64_t *limb = &s->limb[low / limb_bits];
    const int shift = low % limb_bits;
    const uint64_t bits = (uint64_t)limb[0] >> shift | (uint64_t)limb[1] << (limb_bits - shift) |
                          (uint64_t)limb[2] << limb_bits << (limb_bits - shift);
    return (int64_t)(bits & (((uint64_t)1 << mantissa_bits) - 1));
}

static bool any_below(const exact_sum *s, int place)
{
    const int whole = place / limb_bits;
    for (int k = 0; k < whole; k++)
        if (s->limb[k] != 0) return true;
    return (s->limb[whole] & (((int64_t)1 << place % limb_bits) - 1)) != 0;
}

static double magnitude(const exact_sum *s)
{
    const int length = length_of(s), low = length > mantissa_bits ? length - mantissa_bits : 0;
    int64_t mantissa = mantissa_at(s, low);
    if (low > 0 && bit_at(s, low - 1) && (mantissa & 1 || any_below(s, low - 1))) mantissa++;
    return ldexp((double)mantissa, low + unit_exponent);
}

double exact_sum_value(const exact_sum *s)
{
    exact_sum rest = *s;
    if (s->has_nan || (s->has_infinity[0] && s->has_infinity[1])) return (double)NAN;
    if (s->has_infinity[0] || s->has_infinity[1]) return s->has_infinity[0] ? (double)INFINITY : -(double)INFINITY;
    exact_sum_carry(&rest);
    const bool negative = rest.limb[EXACT_SUM_LIMBS - 1] < 0;
    for (int k = 0; negative && k < EXACT_SUM_LIMBS; k++) rest.limb[k] = -rest.limb[k];
    if (negative) exact_sum_carry(&rest);
    return negative ? -magnitude(&rest) : magnitude(&rest);
}
