/* SPDX-License-Identifier: BSD-3-Clause */
/* Carries, sums of many terms, and the one rounding. */
#include "base/exact_sum.h"

#include <math.h>

enum {
    limb_bits = 32,
    mantissa_bits = 53,
    unit_exponent = -1074, /* of 2 */
    block = 256,           /* terms that are split together, */
    lanes = 8              /* so many at a time */
};

static const double too_large = 0x1p1020; /* for what their magnitudes add up to */
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

/* ---- many terms: error-free extraction (Rump, Ogita and Oishi 2008; Demmel and Nguyen 2013) ---- */

static double total(const double lane[lanes])
{
    double sum = 0.0;
    for (int l = 0; l < lanes; l++) sum += lane[l];
    return sum;
}

static double magnitudes(const double *terms, int n)
{
    double sum[lanes] = {0};
    for (int k = 0; k < n; k += lanes)
        for (int l = 0; l < lanes; l++) sum[l] += fabs(terms[k + l]);
    return total(sum);
}

/* Takes from each term its multiple of a unit u, and leaves at most u/2 of it. With 2^e above the sum of magnitudes,
 * u = 2^(e - 51) is the last place of `large`, so that adding and subtracting that rounds to it. The multiples add up
 * to less than 2^(e + 1) = 2^52 u in any order, so their sum is a double. Where u would be below the smallest
 * subnormal number all is exact and nothing is left.  \return the sum of what was taken */
static double extract(double *terms, int n, int e)
{
    const double large = ldexp(1.5, e + 1);
    double sum[lanes] = {0};
    for (int k = 0; k < n; k += lanes)
        for (int l = 0; l < lanes; l++) {
            const double multiple = (terms[k + l] + large) - large;
            terms[k + l] -= multiple;
            sum[l] += multiple;
        }
    return total(sum);
}

/* Each round extracts twice: 2^(e - 43) is above the sum of up to 256 rests of u/2. Usual terms take a round or two,
 * those as far apart as doubles can be some thirty. */
static void add_block(exact_sum *s, const double *terms, int n)
{
    double rest[block];
    int m = n, e;
    memcpy(rest, terms, (size_t)n * sizeof *rest);
    while (m % lanes != 0) rest[m++] = 0.0;
    double size = magnitudes(rest, m);
    for (int k = 0; k < n && !(size < too_large); k++) exact_sum_add(s, terms[k]);
    for (; size > 0.0 && size < too_large; size = magnitudes(rest, m)) {
        (void)frexp(size, &e);
        exact_sum_add(s, extract(rest, m, e));
        exact_sum_add(s, extract(rest, m, e - 43));
    }
}

void exact_sum_add_array(exact_sum *s, const double *terms, int64_t n)
{
    for (int64_t k = 0; k < n; k += block) add_block(s, terms + k, n - k < block ? (int)(n - k) : block);
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
