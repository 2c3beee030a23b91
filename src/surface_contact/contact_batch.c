/* SPDX-License-Identifier: BSD-3-Clause */
/* The comparisons of contact_pair.c with the same numbers, four pairs together with AVX2: what is in reach moves to the
 * front of its vector, and is appended to the batch. */
#include "surface_contact/contact_batch.h"

#include "base/inline.h"
#include "base/instruction_set.h"

#ifdef DEM_X86_KERNELS
#include <immintrin.h>
#endif

void contact_batch_begin(contact_batch *b, const contact_pair *list, dem_index n_pairs, double part)
{
    b->list = list;
    b->n_pairs = n_pairs;
    b->next = 0;
    b->part = part;
    b->n = 0;
}

static void look_at_one(contact_batch *b, const double *x)
{
    const contact_pair *p = &b->list[b->next];
    const edge_terms e = contact_pair_terms(p, b->part, x);
    const int k = b->n;
    b->which[k] = b->next++;
    b->by_edge[k] = e.by_edge ? 1.0 : 0.0;
    b->along[k] = e.along;
    b->front[k] = e.front;
    b->square[k] = e.square;
    b->t_x[k] = e.t.x;
    b->t_y[k] = e.t.y;
    b->radius[k] = e.radius;
    b->thickness[k] = p->thickness;
    b->n += e.by_edge || e.near_first;
}

/* As long as there is any before `end`, and room for it. */
static void look_at_ones(contact_batch *b, dem_index end, const double *x)
{
    while (b->next < end && b->n < CONTACT_BATCH_MOST) look_at_one(b, x);
}

#ifdef DEM_X86_KERNELS
#define WITH_AVX2 __attribute__((target("avx2"))) static inline

/* Vectors of four pairs. */
typedef struct four_vectors {
    __m256d x, y;
} four_vectors;

WITH_AVX2 four_vectors nodes_at(const contact_pair *p, int which, const double *x)
{
    const __m128d n0 = _mm_loadu_pd(x + 2 * p[0].nodes[which]), n1 = _mm_loadu_pd(x + 2 * p[1].nodes[which]);
    const __m128d n2 = _mm_loadu_pd(x + 2 * p[2].nodes[which]), n3 = _mm_loadu_pd(x + 2 * p[3].nodes[which]);
    const __m256d even = _mm256_insertf128_pd(_mm256_castpd128_pd256(n0), n2, 1);
    const __m256d odd = _mm256_insertf128_pd(_mm256_castpd128_pd256(n1), n3, 1);
    return (four_vectors){_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd)};
}

WITH_AVX2 four_vectors differences(four_vectors a, four_vectors b)
{
    return (four_vectors){_mm256_sub_pd(a.x, b.x), _mm256_sub_pd(a.y, b.y)};
}

WITH_AVX2 __m256d dots(four_vectors a, four_vectors b)
{
    return _mm256_add_pd(_mm256_mul_pd(a.x, b.x), _mm256_mul_pd(a.y, b.y));
}

WITH_AVX2 __m256d crosses(four_vectors a, four_vectors b)
{
    return _mm256_sub_pd(_mm256_mul_pd(a.x, b.y), _mm256_mul_pd(a.y, b.x));
}

WITH_AVX2 __m256d is_below(__m256d a, __m256d b)
{
    return _mm256_cmp_pd(a, b, _CMP_LT_OQ);
}

/* Appends those of four numbers that an order moves to the front; behind them the array is not used yet. */
WITH_AVX2 void append(double *array, __m256d four, __m256i order)
{
    const __m256i moved = _mm256_permutevar8x32_epi32(_mm256_castpd_si256(four), order);
    _mm256_storeu_pd(array, _mm256_castsi256_pd(moved));
}

WITH_AVX2 void append_places(dem_index *array, dem_index first, __m256i order)
{
    const __m256i four = _mm256_add_epi64(_mm256_set1_epi64x(first), _mm256_setr_epi64x(0, 1, 2, 3));
    _mm256_storeu_si256((__m256i *)(void *)array, _mm256_permutevar8x32_epi32(four, order));
}

/* Row m moves the numbers at the bits of m to the front; a number has two halves. */
#define AT(q) 2 * (q), 2 * (q) + 1
static const int orders[16][8] = {
    {AT(0), AT(0), AT(0), AT(0)}, {AT(0), AT(0), AT(0), AT(0)}, {AT(1), AT(0), AT(0), AT(0)},
    {AT(0), AT(1), AT(0), AT(0)}, {AT(2), AT(0), AT(0), AT(0)}, {AT(0), AT(2), AT(0), AT(0)},
    {AT(1), AT(2), AT(0), AT(0)}, {AT(0), AT(1), AT(2), AT(0)}, {AT(3), AT(0), AT(0), AT(0)},
    {AT(0), AT(3), AT(0), AT(0)}, {AT(1), AT(3), AT(0), AT(0)}, {AT(0), AT(1), AT(3), AT(0)},
    {AT(2), AT(3), AT(0), AT(0)}, {AT(0), AT(2), AT(3), AT(0)}, {AT(1), AT(2), AT(3), AT(0)},
    {AT(0), AT(1), AT(2), AT(3)}};
static const int counts[16] = {0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4};

WITH_AVX2 void look_at_four(contact_batch *b, const double *x)
{
    const contact_pair *p = &b->list[b->next];
    const four_vectors node = nodes_at(p, CONTACT_PAIR_NODE, x), a = nodes_at(p, CONTACT_PAIR_FIRST, x);
    const four_vectors end = nodes_at(p, CONTACT_PAIR_SECOND, x), r = differences(node, a), t = differences(end, a);
    const __m256d zero = _mm256_setzero_pd(), front = crosses(r, t), along = dots(r, t), square = dots(t, t);
    const __m256d thickness = _mm256_setr_pd(p[0].thickness, p[1].thickness, p[2].thickness, p[3].thickness);
    const __m256d limit = _mm256_mul_pd(_mm256_mul_pd(_mm256_set1_pd(b->part * b->part), thickness), thickness),
                  radius = dots(r, r);
    const __m256d beside =
        _mm256_and_pd(_mm256_cmp_pd(along, zero, _CMP_GE_OQ), is_below(dots(differences(node, end), t), zero));
    const __m256d near = is_below(_mm256_mul_pd(front, front), _mm256_mul_pd(limit, square));
    const __m256d by_edge = _mm256_and_pd(_mm256_and_pd(beside, is_below(zero, front)), near);
    const int reach = _mm256_movemask_pd(_mm256_or_pd(by_edge, is_below(radius, limit))), k = b->n;
    b->next += 4;
    if (reach == 0) return;
    const __m256i order = _mm256_loadu_si256((const __m256i *)(const void *)orders[reach]);
    append(b->by_edge + k, _mm256_and_pd(by_edge, _mm256_set1_pd(1.0)), order);
    append(b->along + k, along, order);
    append(b->front + k, front, order);
    append(b->square + k, square, order);
    append(b->t_x + k, t.x, order);
    append(b->t_y + k, t.y, order);
    append(b->radius + k, radius, order);
    append(b->thickness + k, thickness, order);
    append_places(b->which + k, b->next - 4, order);
    b->n += counts[reach];
}

/* The same of fours. */
__attribute__((target("avx2"))) static void look_at_fours(contact_batch *b, dem_index end, const double *x)
{
    while (b->next + 4 <= end && b->n + 4 <= CONTACT_BATCH_MOST) look_at_four(b, x);
}
#else
#define look_at_fours look_at_ones
#endif

bool contact_batch_next(contact_batch *b, const double *x)
{
    const dem_index fours = instruction_set_avx2() ? b->n_pairs - b->n_pairs % 4 : 0;
    b->n = 0;
    if (b->next < fours) look_at_fours(b, fours, x);
    if (b->next >= fours) look_at_ones(b, b->n_pairs, x);
    return b->n > 0;
}

/* ---- forces ---- */

/* What does not push has any numbers here, and they are not read. */
INLINE void evaluate(contact_batch *b)
{
    for (int k = 0; k < b->n; k++) {
        const edge_terms e = {
            .t = {b->t_x[k], b->t_y[k]}, .along = b->along[k], .front = b->front[k], .square = b->square[k]};
        const edge_push push = contact_pair_edge(e, b->thickness[k]);
        b->share[k] = push.share;
        b->u[k] = push.u;
        b->pressure[k] = push.pressure;
        b->n_x[k] = push.normal.x;
        b->n_y[k] = push.normal.y;
    }
}

#ifdef DEM_X86_KERNELS
__attribute__((target("avx2"))) static void evaluate_avx2(contact_batch *b)
{
    evaluate(b);
}
#else
#define evaluate_avx2 evaluate
#endif

void contact_batch_evaluate(contact_batch *b)
{
    if (instruction_set_avx2())
        evaluate_avx2(b);
    else
        evaluate(b);
}

bool contact_batch_push(const contact_batch *b, int k, const double *x, contact_push *out)
{
    const bool by_edge = b->by_edge[k] != 0.0;
    if (b->list[b->which[k]].fills) return contact_pair_push(&b->list[b->which[k]], x, out);
    *out = by_edge ? contact_batch_edge_push(b, k) : (contact_push){.pair = &b->list[b->which[k]]};
    return contact_pair_push_ends(out->pair, contact_batch_is_near_first(b, k), x, out) || by_edge;
}

double contact_batch_nearness(const contact_batch *b, int k)
{
    if (b->list[b->which[k]].fills) return 1.0;
    const double edge = b->by_edge[k] != 0.0 ? b->u[k] : 1.0, first = sqrt(b->radius[k]) / b->thickness[k];
    return edge < first ? edge : first;
}
