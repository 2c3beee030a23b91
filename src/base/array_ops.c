/* SPDX-License-Identifier: BSD-3-Clause */
/* Arithmetic on whole arrays: linear combinations of vectors, Verlet's step, the sum of squares of the error norm, and
 * the splitting of terms that exact sums are made of (docs/algorithms.md, Determinism). The loops are plain C, which
 * the compiler turns into vector instructions. The file is compiled once for each instruction set, and ARRAY_OPS is the
 * name of the table of functions that it then defines. The tables give the same bits: no operation is fused, an element
 * depends on its own operands alone, and the sums are exact. The forces on the nodes are not here but in
 * elastic/sweep_body.h, and the choice of a table is in array_ops.h. */
#include "base/array_ops.h"

#include <math.h>
#include <string.h>

#include "base/inline.h"

enum {
    most_terms = 8, /* that are added up in one pass */
    piece = 4096    /* of so many numbers partial sums are exact in a double */
};

/* A vector of the machine, so that the compiler keeps it in a register. */
#ifdef __AVX512F__
enum { width = 8 };
#elif defined __AVX__
enum { width = 4 };
#else
enum { width = 2 };
#endif
typedef double vector __attribute__((vector_size(width * sizeof(double))));
typedef int64_t vector_bits __attribute__((vector_size(width * sizeof(double))));

/* A vector of the n numbers from x on. Its other components are 0, which changes no sum. */
INLINE vector vector_at(const double *x, dem_index n)
{
    vector out = {0.0};
    memcpy(&out, x, (size_t)n * sizeof *x);
    return out;
}

/* ---- linear combinations ---- */

/* out = c_0 in_0 + c_1 in_1 + ... in this order for each component, so the bits do not depend on how many components
 * are computed at once. `n` is a constant wherever this is called: the compiler unrolls the inner loop, and all
 * operands are read in one pass. */
INLINE void add_up(double *restrict out, int n, const double *c, const double *const *in, dem_index size)
{
    for (dem_index k = 0; k < size; k++) {
        double sum = c[0] * in[0][k];
        for (int p = 1; p < n; p++) sum += c[p] * in[p][k];
        out[k] = sum;
    }
}

/* Calls add_up() with a constant number of operands, 1 to `most_terms`. */
static void add_few(double *out, int n, const double *c, const double *const *in, dem_index size)
{
    switch (n) {
    case 1:
        add_up(out, 1, c, in, size);
        break;
    case 2:
        add_up(out, 2, c, in, size);
        break;
    case 3:
        add_up(out, 3, c, in, size);
        break;
    case 4:
        add_up(out, 4, c, in, size);
        break;
    case 5:
        add_up(out, 5, c, in, size);
        break;
    case 6:
        add_up(out, 6, c, in, size);
        break;
    case 7:
        add_up(out, 7, c, in, size);
        break;
    default:
        add_up(out, 8, c, in, size);
    }
}

/* A combination of more than `most_terms` operands is added up in pieces that stay in the cache. The partial sum of a
 * piece is a double as it is in a register, so the pieces do not change the bits. */
static void combine(double *out, int n, const double *c, const double *const *in, dem_index size)
{
    if (n <= most_terms) {
        add_few(out, n, c, in, size);
        return;
    }
    double part[piece];
    for (dem_index k = 0; k < size; k += piece) {
        const dem_index here = k + piece < size ? piece : size - k;
        const double *at[most_terms];
        for (int p = 0; p < most_terms; p++) at[p] = in[p] + k;
        add_few(part, most_terms, c, at, here);
        for (int p = most_terms; p < n; p++)
            for (dem_index q = 0; q < here; q++) part[q] += c[p] * in[p][k + q];
        for (dem_index q = 0; q < here; q++) out[k + q] = part[q];
    }
}

/* ---- sums of squares ---- */

typedef struct squares {
    vector highs, lows, most;
} squares;

/* Adds p = e^2 to two sums without a rounding error that depends on the order. p is split into h + l + rest, where h is
 * the multiple of 2^-20 next to p, l is the multiple of 2^-60 next to p - h, and |rest| <= 2^-61 is dropped. Doubles in
 * [2^52 u, 2^53 u) are the multiples of u, so adding 1.5 2^52 u and subtracting it again rounds to a multiple of u: the
 * two constants are those of u = 2^-20 and u = 2^-60. A piece of 4096 = 2^12 squares of at most 2^10 sums up to 2^42
 * units of h and 2^51 units of l at most. Both are below 2^53, so these sums are exact in any order. */
INLINE void add_squares(squares *s, vector e)
{
    const double to_high = 0x1.8p32, to_low = 0x1.8p-8;
    const vector p = e * e, h = (p + to_high) - to_high;
    const vector_bits larger = p > s->most;
    s->highs += h;
    s->lows += ((p - h) + to_low) - to_low;
    s->most = (vector)(((vector_bits)p & larger) | ((vector_bits)s->most & ~larger));
}

/* The sum of (scale x w)^2 over one piece, added to `sum` as integers. The lanes of the vectors are added up here,
 * which is exact again. A square beyond ARRAY_OPS_LARGEST would spoil the splitting: then only `largest` counts, from
 * which the caller sees that the sum does not hold. */
static void square_piece(array_ops_sum *sum, const double *x, const double *w, double scale, dem_index size)
{
    squares s = {{0.0}, {0.0}, {0.0}};
    dem_index k = 0;
    for (; k + width <= size; k += width) add_squares(&s, scale * vector_at(x + k, width) * vector_at(w + k, width));
    if (k < size) add_squares(&s, scale * vector_at(x + k, size - k) * vector_at(w + k, size - k));
    double high = 0.0, low = 0.0, largest = 0.0;
    for (int q = 0; q < width; q++) {
        high += s.highs[q];
        low += s.lows[q];
        largest = s.most[q] > largest ? s.most[q] : largest;
    }
    array_ops_sum here = {.largest = isnan(high) ? high : largest}; /* a square that is none shows in the sum */
    if (here.largest <= ARRAY_OPS_LARGEST) {
        here.high = (int64_t)(high * 0x1p20);
        here.low = (int64_t)(low * 0x1p60);
    }
    array_ops_add(sum, &here);
}

/* Each piece is turned into integers before the next begins, since only the sums of one piece are exact in doubles. */
static void square(array_ops_sum *sum, const double *x, const double *w, double scale, dem_index size)
{
    for (dem_index k = 0; k < size; k += piece)
        square_piece(sum, x + k, w + k, scale, k + piece < size ? piece : size - k);
}

/* ---- Verlet's step ---- */

/* Velocity Verlet, equation (5): v' = v0 + h/2 a0, x1 = x0 + h v'. The velocity is taken on to v1 = v' + h/2 a0, as if
 * the acceleration stayed a0; kick() corrects it when a1 is known. */
static void drift(double *restrict x1, double *restrict v1, const double *const start[3], double h, dem_index size)
{
    const double *x0 = start[0], *v0 = start[1], *a0 = start[2];
    for (dem_index k = 0; k < size; k++) {
        const double half = v0[k] + 0.5 * h * a0[k];
        x1[k] = x0[k] + h * half;
        v1[k] = half + 0.5 * h * a0[k];
    }
}

/* v1 = v' + h/2 a0 + h/2 (a1 - a0) = v' + h/2 a1. */
static void kick(double *restrict v1, const double *a0, const double *a1, double h, dem_index size)
{
    for (dem_index k = 0; k < size; k++) v1[k] += 0.5 * h * (a1[k] - a0[k]);
}

/* ---- lengths ---- */

/* The strain (d - d0)/d0 of each spring from the squared length d^2 that stands in its place. */
static void stretch(double *lengths, const double *reference, int n)
{
    for (int k = 0; k < n; k++) lengths[k] = (sqrt(lengths[k]) - reference[k]) / reference[k];
}

/* ---- exact sums: error-free extraction (Rump, Ogita and Oishi 2008; Demmel and Nguyen 2013) ---- */

/* |x| of each component: the sign bit is cleared. */
INLINE vector magnitudes(vector x)
{
    return (vector)((vector_bits)x & 0x7fffffffffffffff);
}

/* The sum of every second component, from the first or the second one on. */
INLINE double total(vector x, int from)
{
    double sum = 0.0;
    for (int q = from; q < width; q += 2) sum += x[q];
    return sum;
}

/* Sums of |terms|, bounds for their sums. They are rounded, so they depend on the instruction set; the exact sum does
 * not, since split() is free of error for any bound that is large enough. */
static void magnitude(double size[2], const double *terms, int n)
{
    vector sum[2] = {{0.0}, {0.0}};
    for (int k = 0; k < n; k += ARRAY_OPS_LANES) {
        UNROLLED for (int q = 0; q < ARRAY_OPS_LANES / width; q++)
        {
            sum[q % 2] += magnitudes(vector_at(terms + k + q * width, width));
        }
    }
    for (int c = 0; c < 2; c++) size[c] = total(sum[0] + sum[1], c);
}

/* The largest power of 2 that is not above a number > 0: its exponent bits without the mantissa. For a subnormal number
 * these bits are 0. */
INLINE double power_of(double size)
{
    uint64_t bits;
    memcpy(&bits, &size, sizeof bits);
    bits &= 0x7ff0000000000000;
    memcpy(&size, &bits, sizeof size);
    return size;
}

/* Adds terms to sums that lie in [2^k, 2^(k+1)] before and after. There the doubles are the multiples of u = 2^(k-52),
 * so the addition rounds each term to a multiple of u, and *sum - before is exactly what has been added.
 * \return what the rounding has left of the terms, at most u/2 each; exact */
INLINE vector extract(vector *sum, vector terms)
{
    const vector before = *sum;
    *sum += terms;
    return terms - (*sum - before);
}

/* Sums by turns of two, so that an addition need not wait for the one before, and the bits of what is left of all
 * terms. */
typedef struct extraction {
    vector high[2], low[2];
    vector_bits left;
} extraction;

/* \param keep  whether what is left of the terms takes their place */
INLINE void extract_all(extraction *e, double *terms, int n, bool keep)
{
    for (int k = 0; k < n; k += ARRAY_OPS_LANES) {
        UNROLLED for (int q = 0; q < ARRAY_OPS_LANES / width; q++)
        {
            double *here = terms + k + q * width;
            const vector rest = extract(&e->low[q % 2], extract(&e->high[q % 2], vector_at(here, width)));
            if (keep) memcpy(here, &rest, sizeof rest);
            e->left |= (vector_bits)rest;
        }
    }
}

/* Whether anything but zeros is left. */
INLINE bool is_left(vector_bits left)
{
    int64_t bits = 0;
    for (int q = 0; q < width; q++) bits |= left[q];
    return (bits & 0x7fffffffffffffff) != 0;
}

/* Error-free extraction, of the terms at even and at odd places each by itself. Let p be the power of 2 with p <= size
 * < 2p; the magnitudes of the terms add up to less than 2p. `high` begins half-way between 8p and 16p, so it stays in
 * that interval and its last place is u = 2^-49 p: at most 2^-50 p is left of a term. At most 128 terms are in a lane,
 * and what is left of them adds up to at most 2^-43 p. `low` begins half-way between 2^-42 p and 2^-41 p and takes that
 * up in the same way. What a lane has collected is a multiple of u of at most 53 bits, and so are the sums over the
 * lanes, which are the parts: these are exact, and
 *     sum of the terms = sum of the parts + sum of what is left in their place.
 * Where p is so small that u would be below the smallest subnormal number, every addition is exact and nothing is left.
 * Seldom is anything left: then the same is done once more, and kept. */
static bool split(double parts[4], double *terms, int n, const double size[2])
{
    vector highs, lows;
    for (int q = 0; q < width; q++) {
        const double p = power_of(size[q % 2]);
        highs[q] = 12.0 * p;
        lows[q] = 0x1.8p-42 * p;
    }
    extraction e = {{highs, highs}, {lows, lows}, {0}};
    extract_all(&e, terms, n, false);
    for (int c = 0; c < 2; c++) {
        parts[c] = total((e.high[0] - highs) + (e.high[1] - highs), c);
        parts[2 + c] = total((e.low[0] - lows) + (e.low[1] - lows), c);
    }
    const bool left = is_left(e.left);
    e = (extraction){{highs, highs}, {lows, lows}, {0}};
    if (left) extract_all(&e, terms, n, true);
    return left;
}

const array_ops ARRAY_OPS = {combine, square, drift, kick, stretch, magnitude, split};
