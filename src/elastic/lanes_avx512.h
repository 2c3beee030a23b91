/* SPDX-License-Identifier: BSD-3-Clause */
/* The vectors of the sweep in AVX-512 F, DQ and VL. FMA instructions are used in quotients only, where they lead to the
 * same bits as a division. */
#ifndef DEM_ELASTIC_LANES_AVX512_H
#define DEM_ELASTIC_LANES_AVX512_H

#include <immintrin.h>

#include "base/inline.h"
#include "elastic/layout.h"

typedef struct pairs {
    __m512d low, high; /* nodes 0 to 3, 4 to 7 */
} pairs;

typedef __m512d lanes; /* of nodes 0 4 1 5 2 6 3 7 */

/* Compilers put eight numbers together in memory, and the load has to wait for their stores. */
INLINE pairs pairs_both(double x, double y)
{
    const __m512d a = _mm512_broadcast_f64x2(_mm_setr_pd(x, y));
    return (pairs){a, a};
}

INLINE pairs pairs_load(const double *p)
{
    return (pairs){_mm512_loadu_pd(p), _mm512_loadu_pd(p + 8)};
}

INLINE void pairs_store(double *p, pairs a)
{
    _mm512_storeu_pd(p, a.low);
    _mm512_storeu_pd(p + 8, a.high);
}

INLINE __m256d gather_two(const double *array, const int32_t *index)
{
    const __m128d a = _mm_loadu_pd(array + index[0]), b = _mm_loadu_pd(array + index[1]);
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(a), b, 1);
}

INLINE __m512d gather_four(const double *array, const int32_t *index)
{
    return _mm512_insertf64x4(_mm512_castpd256_pd512(gather_two(array, index)), gather_two(array, index + 2), 1);
}

INLINE pairs pairs_gather(const double *array, const int32_t *index)
{
    return (pairs){gather_four(array, index), gather_four(array, index + 4)};
}

INLINE pairs pairs_spread(const double *p)
{
    const __m512d a = _mm512_loadu_pd(p);
    return (pairs){_mm512_permutexvar_pd(_mm512_setr_epi64(0, 0, 1, 1, 2, 2, 3, 3), a),
                   _mm512_permutexvar_pd(_mm512_setr_epi64(4, 4, 5, 5, 6, 6, 7, 7), a)};
}

INLINE pairs pairs_mask(pairs a, unsigned mask)
{
    return (pairs){_mm512_maskz_mov_pd((__mmask8)mask, a.low), _mm512_maskz_mov_pd((__mmask8)(mask >> 8), a.high)};
}

/* Of the nodes in the mask. */
INLINE pairs pairs_negate(pairs a, unsigned mask)
{
    const __m512d sign = _mm512_set1_pd(-0.0);
    return (pairs){_mm512_mask_xor_pd(a.low, (__mmask8)mask, a.low, sign),
                   _mm512_mask_xor_pd(a.high, (__mmask8)(mask >> 8), a.high, sign)};
}

INLINE pairs pairs_unless_zero(pairs where, pairs a)
{
    const __m512d zero = _mm512_setzero_pd();
    return (pairs){_mm512_maskz_mov_pd(_mm512_cmp_pd_mask(where.low, zero, _CMP_NEQ_UQ), a.low),
                   _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(where.high, zero, _CMP_NEQ_UQ), a.high)};
}

INLINE pairs pairs_swap(pairs a)
{
    return (pairs){_mm512_permute_pd(a.low, 0x55), _mm512_permute_pd(a.high, 0x55)};
}

INLINE pairs pairs_add(pairs a, pairs b)
{
    return (pairs){_mm512_add_pd(a.low, b.low), _mm512_add_pd(a.high, b.high)};
}

INLINE pairs pairs_sub(pairs a, pairs b)
{
    return (pairs){_mm512_sub_pd(a.low, b.low), _mm512_sub_pd(a.high, b.high)};
}

INLINE pairs pairs_mul(pairs a, pairs b)
{
    return (pairs){_mm512_mul_pd(a.low, b.low), _mm512_mul_pd(a.high, b.high)};
}

INLINE double pairs_total(pairs a)
{
    return _mm512_reduce_add_pd(_mm512_add_pd(a.low, a.high));
}

INLINE pairs pairs_scale(lanes s, pairs a)
{
    return (pairs){_mm512_mul_pd(_mm512_unpacklo_pd(s, s), a.low), _mm512_mul_pd(_mm512_unpackhi_pd(s, s), a.high)};
}

INLINE lanes pairs_dot(pairs a, pairs b)
{
    const pairs c = pairs_mul(a, b);
    return _mm512_add_pd(_mm512_unpacklo_pd(c.low, c.high), _mm512_unpackhi_pd(c.low, c.high));
}

INLINE lanes pairs_cross(pairs a, pairs b)
{
    const pairs c = pairs_mul(a, pairs_swap(b));
    return _mm512_sub_pd(_mm512_unpacklo_pd(c.low, c.high), _mm512_unpackhi_pd(c.low, c.high));
}

INLINE lanes lanes_all(double value)
{
    return _mm512_set1_pd(value);
}

INLINE lanes lanes_load(const double *p)
{
    return _mm512_loadu_pd(p);
}

INLINE lanes lanes_add(lanes a, lanes b)
{
    return _mm512_add_pd(a, b);
}

INLINE lanes lanes_sub(lanes a, lanes b)
{
    return _mm512_sub_pd(a, b);
}

INLINE lanes lanes_mul(lanes a, lanes b)
{
    return _mm512_mul_pd(a, b);
}

/* 1 - b y, by which an inverse y of b is wrong. */
INLINE lanes lanes_inverse_error(lanes b, lanes y)
{
    return _mm512_fnmadd_pd(b, y, _mm512_set1_pd(1.0));
}

#ifdef LANES_DIVIDE
/** a/b by the divider, where that is faster (sweep_avx512_divider.c). */
INLINE lanes lanes_div(lanes a, lanes b)
{
    return _mm512_div_pd(a, b);
}
#else
/** a/b for b > 0 with the bits of a division, which would wait for the divider, where the square roots are. The
 *  estimate of the inverse has 14 bits, which differ between makers; y + y (1 - b y) leaves it within an ulp at the
 *  second time, and at the third rounds it correctly, so that the quotient, corrected by its remainder, is right, too
 *  (P. Markstein, IBM J. Res. Dev. 34 (1990) 111). Where all bits of b's significand are 1 that needs an inverse which
 *  is not too small before, therefore the second is rounded up. Zeros keep their sign. Other than by a division an
 *  infinite quotient, and one by infinity, is NAN, and nothing holds where a remainder or an inverse is subnormal. */
INLINE lanes lanes_div(lanes a, lanes b)
{
    const lanes sign = _mm512_set1_pd(-0.0);
    lanes inverse = _mm512_rcp14_pd(b);
    inverse = _mm512_fmadd_pd(inverse, lanes_inverse_error(b, inverse), inverse);
    inverse = _mm512_fmadd_round_pd(inverse, lanes_inverse_error(b, inverse), inverse,
                                    _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC);
    inverse = _mm512_fmadd_pd(inverse, lanes_inverse_error(b, inverse), inverse);
    const lanes quotient = _mm512_mul_pd(a, inverse);
    const lanes nearest = _mm512_fmadd_pd(_mm512_fnmadd_pd(b, quotient, a), inverse, quotient);
    return _mm512_or_pd(nearest, _mm512_and_pd(a, sign));
}
#endif

INLINE lanes lanes_sqrt(lanes a)
{
    return _mm512_sqrt_pd(a);
}

/** Bit layout_lane(q) is that of node q. */
INLINE unsigned lanes_below(lanes a, lanes b)
{
    return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
}

static inline void lanes_store(double *p, lanes a)
{
    _mm512_storeu_pd(p, a);
}

/** a < b ? a : b */
static inline lanes lanes_min(lanes a, lanes b)
{
    return _mm512_min_pd(a, b);
}

/** a > b ? a : b */
static inline lanes lanes_max(lanes a, lanes b)
{
    return _mm512_max_pd(a, b);
}

/** a in the lanes that are chosen, by bits as in lanes_below(), b in the others. */
static inline lanes lanes_where(unsigned chosen, lanes a, lanes b)
{
    return _mm512_mask_mov_pd(b, (__mmask8)chosen, a);
}

/** a where `where` is not 0, else 0. */
static inline lanes lanes_unless_zero(lanes where, lanes a)
{
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(where, _mm512_setzero_pd(), _CMP_NEQ_UQ), a);
}

/** Of lanes in the order of memory the ones before: the last of `before`, and the first seven of a. */
INLINE lanes lanes_behind(lanes before, lanes a)
{
    return _mm512_castsi512_pd(_mm512_alignr_epi64(_mm512_castpd_si512(a), _mm512_castpd_si512(before), 7));
}

/** And the ones behind: the last seven of a, and the first of `after`. */
INLINE lanes lanes_ahead(lanes a, lanes after)
{
    return _mm512_castsi512_pd(_mm512_alignr_epi64(_mm512_castpd_si512(after), _mm512_castpd_si512(a), 1));
}

#endif
