/* SPDX-License-Identifier: BSD-3-Clause */
/* The vectors of the sweep in AVX2. FMA instructions are not used, since their bits would differ. */
#ifndef DEM_ELASTIC_LANES_AVX2_H
#define DEM_ELASTIC_LANES_AVX2_H

#include <immintrin.h>

#include "base/inline.h"
#include "elastic/layout.h"

typedef struct pairs {
    __m256d n[4]; /* nodes 0 and 1, 2 and 3, ... */
} pairs;

typedef struct lanes {
    __m256d low, high; /* of nodes 0 4 1 5, 2 6 3 7 */
} lanes;

#define EACH UNROLLED for (int k = 0; k < 4; k++)

INLINE pairs pairs_both(double x, double y)
{
    const __m256d a = _mm256_setr_pd(x, y, x, y);
    return (pairs){{a, a, a, a}};
}

INLINE pairs pairs_load(const double *p)
{
    return (pairs){{_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4), _mm256_loadu_pd(p + 8), _mm256_loadu_pd(p + 12)}};
}

INLINE void pairs_store(double *p, pairs a)
{
    EACH _mm256_storeu_pd(p + 4 * k, a.n[k]);
}

INLINE __m256d gather_two(const double *array, const int32_t *index)
{
    const __m128d a = _mm_loadu_pd(array + index[0]), b = _mm_loadu_pd(array + index[1]);
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(a), b, 1);
}

INLINE pairs pairs_gather(const double *array, const int32_t *index)
{
    return (pairs){{gather_two(array, index), gather_two(array, index + 2), gather_two(array, index + 4),
                    gather_two(array, index + 6)}};
}

INLINE pairs pairs_spread(const double *p)
{
    const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4);
    return (pairs){{_mm256_permute4x64_pd(a, 0x50), _mm256_permute4x64_pd(a, 0xfa), _mm256_permute4x64_pd(b, 0x50),
                    _mm256_permute4x64_pd(b, 0xfa)}};
}

/* All bits of the numbers k of which bit k is in the mask. */
INLINE __m256d spread_bits(unsigned mask)
{
    const __m256i bits = _mm256_setr_epi64x(1, 2, 4, 8);
    const __m256i here = _mm256_and_si256(_mm256_set1_epi64x((long long)mask), bits);
    return _mm256_castsi256_pd(_mm256_cmpeq_epi64(here, bits));
}

INLINE pairs pairs_mask(pairs a, unsigned mask)
{
    EACH a.n[k] = _mm256_and_pd(a.n[k], spread_bits(mask >> (4 * k)));
    return a;
}

/* Of the nodes in the mask. */
INLINE pairs pairs_negate(pairs a, unsigned mask)
{
    EACH a.n[k] = _mm256_xor_pd(a.n[k], _mm256_and_pd(_mm256_set1_pd(-0.0), spread_bits(mask >> (4 * k))));
    return a;
}

INLINE pairs pairs_unless_zero(pairs where, pairs a)
{
    EACH a.n[k] = _mm256_and_pd(a.n[k], _mm256_cmp_pd(where.n[k], _mm256_setzero_pd(), _CMP_NEQ_UQ));
    return a;
}

INLINE pairs pairs_swap(pairs a)
{
    EACH a.n[k] = _mm256_permute_pd(a.n[k], 0x5);
    return a;
}

INLINE pairs pairs_add(pairs a, pairs b)
{
    EACH a.n[k] = _mm256_add_pd(a.n[k], b.n[k]);
    return a;
}

INLINE pairs pairs_sub(pairs a, pairs b)
{
    EACH a.n[k] = _mm256_sub_pd(a.n[k], b.n[k]);
    return a;
}

INLINE pairs pairs_mul(pairs a, pairs b)
{
    EACH a.n[k] = _mm256_mul_pd(a.n[k], b.n[k]);
    return a;
}

INLINE double pairs_total(pairs a)
{
    double part[4];
    _mm256_storeu_pd(part, _mm256_add_pd(_mm256_add_pd(a.n[0], a.n[1]), _mm256_add_pd(a.n[2], a.n[3])));
    return part[0] + part[1] + part[2] + part[3];
}

INLINE pairs pairs_scale(lanes s, pairs a)
{
    return (pairs){{_mm256_mul_pd(_mm256_unpacklo_pd(s.low, s.low), a.n[0]),
                    _mm256_mul_pd(_mm256_unpacklo_pd(s.high, s.high), a.n[1]),
                    _mm256_mul_pd(_mm256_unpackhi_pd(s.low, s.low), a.n[2]),
                    _mm256_mul_pd(_mm256_unpackhi_pd(s.high, s.high), a.n[3])}};
}

INLINE lanes pairs_dot(pairs a, pairs b)
{
    const pairs c = pairs_mul(a, b);
    return (lanes){_mm256_add_pd(_mm256_unpacklo_pd(c.n[0], c.n[2]), _mm256_unpackhi_pd(c.n[0], c.n[2])),
                   _mm256_add_pd(_mm256_unpacklo_pd(c.n[1], c.n[3]), _mm256_unpackhi_pd(c.n[1], c.n[3]))};
}

INLINE lanes pairs_cross(pairs a, pairs b)
{
    const pairs c = pairs_mul(a, pairs_swap(b));
    return (lanes){_mm256_sub_pd(_mm256_unpacklo_pd(c.n[0], c.n[2]), _mm256_unpackhi_pd(c.n[0], c.n[2])),
                   _mm256_sub_pd(_mm256_unpacklo_pd(c.n[1], c.n[3]), _mm256_unpackhi_pd(c.n[1], c.n[3]))};
}

INLINE lanes lanes_all(double value)
{
    return (lanes){_mm256_set1_pd(value), _mm256_set1_pd(value)};
}

INLINE lanes lanes_load(const double *p)
{
    return (lanes){_mm256_loadu_pd(p), _mm256_loadu_pd(p + 4)};
}

INLINE lanes lanes_add(lanes a, lanes b)
{
    return (lanes){_mm256_add_pd(a.low, b.low), _mm256_add_pd(a.high, b.high)};
}

INLINE lanes lanes_sub(lanes a, lanes b)
{
    return (lanes){_mm256_sub_pd(a.low, b.low), _mm256_sub_pd(a.high, b.high)};
}

INLINE lanes lanes_mul(lanes a, lanes b)
{
    return (lanes){_mm256_mul_pd(a.low, b.low), _mm256_mul_pd(a.high, b.high)};
}

INLINE lanes lanes_div(lanes a, lanes b)
{
    return (lanes){_mm256_div_pd(a.low, b.low), _mm256_div_pd(a.high, b.high)};
}

INLINE lanes lanes_sqrt(lanes a)
{
    return (lanes){_mm256_sqrt_pd(a.low), _mm256_sqrt_pd(a.high)};
}

/** Bit layout_lane(q) is that of node q. */
INLINE unsigned lanes_below(lanes a, lanes b)
{
    const int low = _mm256_movemask_pd(_mm256_cmp_pd(a.low, b.low, _CMP_LT_OQ));
    const int high = _mm256_movemask_pd(_mm256_cmp_pd(a.high, b.high, _CMP_LT_OQ));
    return (unsigned)(low | high << 4);
}

static inline void lanes_store(double *p, lanes a)
{
    _mm256_storeu_pd(p, a.low);
    _mm256_storeu_pd(p + 4, a.high);
}

/** a < b ? a : b */
static inline lanes lanes_min(lanes a, lanes b)
{
    return (lanes){_mm256_min_pd(a.low, b.low), _mm256_min_pd(a.high, b.high)};
}

/** a > b ? a : b */
static inline lanes lanes_max(lanes a, lanes b)
{
    return (lanes){_mm256_max_pd(a.low, b.low), _mm256_max_pd(a.high, b.high)};
}

/** a in the lanes that are chosen, by bits as in lanes_below(), b in the others. */
static inline lanes lanes_where(unsigned chosen, lanes a, lanes b)
{
    return (lanes){_mm256_blendv_pd(b.low, a.low, spread_bits(chosen)),
                   _mm256_blendv_pd(b.high, a.high, spread_bits(chosen >> 4))};
}

#undef EACH

#endif
