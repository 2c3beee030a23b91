/* SPDX-License-Identifier: BSD-3-Clause */
/* The comparisons of contact_pair.c with the same numbers, four pairs together with AVX2: what is in reach moves to the
 * front of its vector, and is appended to the batch. */
#include "surface_contact/contact_batch.h"

#include "base/inline.h"
#include "base/instruction_set.h"

#ifdef DEM_X86_KERNELS
#include <immintrin.h>
#endif

void contact_batch_begin(contact_batch *b, const compact_pairs *of, double part)
{
    b->of = of;
    b->next = 0;
    b->part = part;
    b->n = 0;
}

/* The place of a pair and what is known of it. */
static dem_index which_of(dem_index place, const edge_terms *e)
{
    return 4 * place + (e->by_edge ? CONTACT_BATCH_BY_EDGE : 0) + (e->near_first ? CONTACT_BATCH_NEAR_FIRST : 0);
}

static void look_at_one(contact_batch *b)
{
    const compact_pair *p = &b->of->pairs[b->next];
    const double *x = b->of->x;
    const vec2 node = vec2_at(x + p->rows[CONTACT_PAIR_NODE], 0), first = vec2_at(x + p->rows[CONTACT_PAIR_FIRST], 0);
    const vec2 second = vec2_at(x + p->rows[CONTACT_PAIR_SECOND], 0);
    const edge_terms e = contact_pair_terms_at(node, first, second, b->part, p->thickness);
    const int k = b->n;
    b->which[k] = which_of(b->next++, &e);
    b->along[k] = e.along;
    b->front[k] = e.front;
    b->square[k] = e.square;
    b->t_x[k] = e.t.x;
    b->t_y[k] = e.t.y;
    b->thickness[k] = p->thickness;
    b->n += e.by_edge || e.near_first;
}

/* As long as there is any before `end`, and room for it. */
static void look_at_ones(contact_batch *b, dem_index end)
{
    while (b->next < end && b->n < CONTACT_BATCH_MOST) look_at_one(b);
}

#ifdef DEM_X86_KERNELS
#define WITH_AVX2 __attribute__((target("avx2"))) static inline

/* Vectors of four pairs. */
typedef struct four_vectors {
    __m256d x, y;
} four_vectors;

WITH_AVX2 four_vectors nodes_at(const compact_pair *p, int which, const double *x)
{
    const __m128d n0 = _mm_loadu_pd(x + p[0].rows[which]), n1 = _mm_loadu_pd(x + p[1].rows[which]);
    const __m128d n2 = _mm_loadu_pd(x + p[2].rows[which]), n3 = _mm_loadu_pd(x + p[3].rows[which]);
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

/* Likewise of places, with what is known of their pairs. */
WITH_AVX2 void append_places(dem_index *array, dem_index first, __m256d by_edge, __m256d near_first, __m256i order)
{
    const __m256i places = _mm256_add_epi64(_mm256_set1_epi64x(4 * first), _mm256_setr_epi64x(0, 4, 8, 12));
    const __m256i edge = _mm256_and_si256(_mm256_castpd_si256(by_edge), _mm256_set1_epi64x(CONTACT_BATCH_BY_EDGE));
    const __m256i near =
        _mm256_and_si256(_mm256_castpd_si256(near_first), _mm256_set1_epi64x(CONTACT_BATCH_NEAR_FIRST));
    const __m256i four = _mm256_or_si256(places, _mm256_or_si256(edge, near));
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

/* \return how many of four pairs from the place `next` on are in reach */
WITH_AVX2 int look_at_four(contact_batch *b, dem_index next, int k)
{
    const compact_pair *p = &b->of->pairs[next];
    const double *x = b->of->x;
    const four_vectors node = nodes_at(p, CONTACT_PAIR_NODE, x), a = nodes_at(p, CONTACT_PAIR_FIRST, x);
    const four_vectors end = nodes_at(p, CONTACT_PAIR_SECOND, x), r = differences(node, a), t = differences(end, a);
    const __m256d zero = _mm256_setzero_pd(), front = crosses(r, t), along = dots(r, t), square = dots(t, t);
    const __m256d thickness = _mm256_setr_pd(p[0].thickness, p[1].thickness, p[2].thickness, p[3].thickness);
    const __m256d limit = _mm256_mul_pd(_mm256_mul_pd(_mm256_set1_pd(b->part * b->part), thickness), thickness);
    const __m256d beside =
        _mm256_and_pd(_mm256_cmp_pd(along, zero, _CMP_GE_OQ), is_below(dots(differences(node, end), t), zero));
    const __m256d near = is_below(_mm256_mul_pd(front, front), _mm256_mul_pd(limit, square));
    const __m256d by_edge = _mm256_and_pd(_mm256_and_pd(beside, is_below(zero, front)), near);
    const __m256d near_first = is_below(dots(r, r), limit);
    const int reach = _mm256_movemask_pd(_mm256_or_pd(by_edge, near_first));
    if (reach == 0) return 0;
    const __m256i order = _mm256_loadu_si256((const __m256i *)(const void *)orders[reach]);
    append(b->along + k, along, order);
    append(b->front + k, front, order);
    append(b->square + k, square, order);
    append(b->t_x + k, t.x, order);
    append(b->t_y + k, t.y, order);
    append(b->thickness + k, thickness, order);
    append_places(b->which + k, next, by_edge, near_first, order);
    return counts[reach];
}

/* The same of fours. */
__attribute__((target("avx2"))) static void look_at_fours(contact_batch *b, dem_index end)
{
    dem_index next = b->next;
    int n = b->n;
    for (; next + 4 <= end && n + 4 <= CONTACT_BATCH_MOST; next += 4) n += look_at_four(b, next, n);
    b->next = next;
    b->n = n;
}
#else
#define look_at_fours look_at_ones
#endif

bool contact_batch_next(contact_batch *b)
{
    const dem_index n = b->of->n, fours = instruction_set_avx2() ? n - n % 4 : 0;
    b->n = 0;
    if (b->next < fours) look_at_fours(b, fours);
    if (b->next >= fours) look_at_ones(b, n);
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
    const contact_pair *p = contact_batch_pair(b, k);
    const bool by_edge = contact_batch_is_by_edge(b, k);
    if (p->fills) return contact_pair_push(p, x, out);
    *out = by_edge ? contact_batch_edge_push(b, k) : (contact_push){.pair = p};
    return contact_pair_push_ends(p, (b->which[k] & CONTACT_BATCH_NEAR_FIRST) != 0, x, out) || by_edge;
}

double contact_batch_nearness(const contact_batch *b, int k, const double *x)
{
    const contact_pair *p = contact_batch_pair(b, k);
    if (p->fills) return 1.0;
    const vec2 r = vec2_sub(vec2_at(x, p->nodes[CONTACT_PAIR_NODE]), vec2_at(x, p->nodes[CONTACT_PAIR_FIRST]));
    const double edge = contact_batch_is_by_edge(b, k) ? b->u[k] : 1.0, first = vec2_norm(r) / p->thickness;
    return edge < first ? edge : first;
}
