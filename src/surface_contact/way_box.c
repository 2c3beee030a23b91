/* SPDX-License-Identifier: BSD-3-Clause */
/* The box of ways, with AVX2 where the machine has it: compilers do not make minima of vectors out of comparisons. A
 * least and a largest number are the same in any order, and so are their bits. */
#include "surface_contact/way_box.h"

#include "base/instruction_set.h"

#ifdef DEM_X86_KERNELS
#include <immintrin.h>
#endif

static box box_of_twos(const double *x, const dem_index *at, const double *from, dem_index n)
{
    box ways = box_empty();
    for (dem_index k = 0; k < 2 * n; k++)
        ways = box_with(ways, vec2_sub(vec2_at(x + at[k / 2], k % 2), vec2_at(from, k)));
    return ways;
}

#ifdef DEM_X86_KERNELS
#define WITH_AVX2 __attribute__((target("avx2"))) static

/* The boxes of the first and of the second points. */
typedef struct two_boxes {
    __m256d low, high;
} two_boxes;

WITH_AVX2 inline two_boxes add_two(two_boxes b, const double *x, const double *from)
{
    const __m256d way = _mm256_sub_pd(_mm256_loadu_pd(x), _mm256_loadu_pd(from));
    return (two_boxes){_mm256_min_pd(way, b.low), _mm256_max_pd(way, b.high)};
}

/* Twos in turns, so that no minimum waits for the one before it. */
WITH_AVX2 box box_of_vectors(const double *x, const dem_index *at, const double *from, dem_index n)
{
    two_boxes a = {_mm256_set1_pd(INFINITY), _mm256_set1_pd(-INFINITY)}, b = a;
    box ways;
    for (dem_index k = 0; k + 1 < n; k += 2) {
        a = add_two(a, x + at[k], from + 4 * k);
        b = add_two(b, x + at[k + 1], from + 4 * k + 4);
    }
    if (n % 2 == 1) a = add_two(a, x + at[n - 1], from + 4 * (n - 1));
    const __m256d low = _mm256_min_pd(a.low, b.low), high = _mm256_max_pd(a.high, b.high);
    _mm_storeu_pd(&ways.low.x, _mm_min_pd(_mm256_castpd256_pd128(low), _mm256_extractf128_pd(low, 1)));
    _mm_storeu_pd(&ways.high.x, _mm_max_pd(_mm256_castpd256_pd128(high), _mm256_extractf128_pd(high, 1)));
    return ways;
}
#else
#define box_of_vectors box_of_twos
#endif

box way_box_of(const double *x, const dem_index *at, const double *from, dem_index n)
{
    return instruction_set_avx2() ? box_of_vectors(x, at, from, n) : box_of_twos(x, at, from, n);
}
