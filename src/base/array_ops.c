/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops for the compiler to make vector instructions of. ARRAY_OPS is the name of the table, one for each set of
 * them. */
#include "base/array_ops.h"

#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

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

/* The numbers from x on, zeros behind them. */
INLINE vector vector_at(const double *x, dem_index n)
{
    vector out = {0.0};
    memcpy(&out, x, (size_t)n * sizeof *x);
    return out;
}

/* ---- linear combinations ---- */

/* `n` is a constant where this is called, so that the inner loop is none. */
INLINE void add_up(double *restrict out, int n, const double *c, const double *const *in, dem_index size)
{
    for (dem_index k = 0; k < size; k++) {
        double sum = c[0] * in[0][k];
        for (int p = 1; p < n; p++) sum += c[p] * in[p][k];
        out[k] = sum;
    }
}

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

/* More than `most_terms` in pieces that stay in the cache. */
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

/* p = h + l + rest, h a multiple of 2^-20 and l of 2^-60, |rest| <= 2^-61: adding and taking away 1.5 2^(52 - 20)
 * rounds to the one, 1.5 2^(52 - 60) to the other. The sums of a piece are exact in any order: they have at most 53
 * bits. */
INLINE void add_squares(squares *s, vector e)
{
    const double to_high = 0x1.8p32, to_low = 0x1.8p-8;
    const vector p = e * e, h = (p + to_high) - to_high;
    const vector_bits larger = p > s->most;
    s->highs += h;
    s->lows += ((p - h) + to_low) - to_low;
    s->most = (vector)(((vector_bits)p & larger) | ((vector_bits)s->most & ~larger));
}

/* Behind the end stand zeros. */
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

static void square(array_ops_sum *sum, const double *x, const double *w, double scale, dem_index size)
{
    for (dem_index k = 0; k < size; k += piece)
        square_piece(sum, x + k, w + k, scale, k + piece < size ? piece : size - k);
}

/* ---- Verlet's step ---- */

static void drift(double *restrict x1, double *restrict v1, const double *const start[3], double h, dem_index size)
{
    const double *x0 = start[0], *v0 = start[1], *a0 = start[2];
    for (dem_index k = 0; k < size; k++) {
        const double half = v0[k] + 0.5 * h * a0[k];
        x1[k] = x0[k] + h * half;
        v1[k] = half + 0.5 * h * a0[k];
    }
}

static void kick(double *restrict v1, const double *a0, const double *a1, double h, dem_index size)
{
    for (dem_index k = 0; k < size; k++) v1[k] += 0.5 * h * (a1[k] - a0[k]);
}

/* ---- lengths ---- */

static void stretch(double *lengths, const double *reference, int n)
{
    for (int k = 0; k < n; k++) lengths[k] = (sqrt(lengths[k]) - reference[k]) / reference[k];
}

/* ---- exact sums: error-free extraction (Rump, Ogita and Oishi 2008; Demmel and Nguyen 2013) ---- */

INLINE vector magnitudes(vector x)
{
    return (vector)((vector_bits)x & 0x7fffffffffffffff);
}

INLINE double total(vector x)
{
    double sum = 0.0;
    for (int q = 0; q < width; q++) sum += x[q];
    return sum;
}

static double magnitude(const double *terms, int n)
{
    vector sum = {0.0};
    for (int k = 0; k < n; k += ARRAY_OPS_LANES)
        for (int q = 0; q < ARRAY_OPS_LANES; q += width) sum += magnitudes(vector_at(terms + k + q, width));
    return total(sum);
}

/* The power of 2 up to a number > 0, 0 of one that is subnormal. */
INLINE double power_of(double size)
{
    uint64_t bits;
    memcpy(&bits, &size, sizeof bits);
    bits &= 0x7ff0000000000000;
    memcpy(&size, &bits, sizeof size);
    return size;
}

/* Adds terms to sums in [2^k, 2^(k+1)], which stay there: this rounds to the last place u = 2^(k-52) of the sums.
 * \return what rounding leaves of the terms, at most u/2 each */
INLINE vector extract(vector *sum, vector terms)
{
    const vector before = *sum;
    *sum += terms;
    return terms - (*sum - before);
}

/* The magnitudes of the terms add up to less than 2p: `high` begins half-way between 8p and 16p, so that at most
 * 2^-50 p is left of a term, and as many as there are in a lane leave at most 2^-43 p: `low` begins half-way between
 * 2^-42 p and 2^-41 p. What the lanes have added up has at most 53 bits in units of u, so that totals are exact. Where
 * p is so small that there is no such u all sums are exact, and nothing is left. */
static double split(double parts[2], double *terms, int n, double size)
{
    const double p = power_of(size), from_high = 12.0 * p, from_low = 0x1.8p-42 * p;
    vector high = from_high + (vector){0.0}, low = from_low + (vector){0.0}, left = {0.0};
    for (int k = 0; k < n; k += ARRAY_OPS_LANES)
        for (int q = 0; q < ARRAY_OPS_LANES; q += width) {
            const vector rest = extract(&low, extract(&high, vector_at(terms + k + q, width)));
            memcpy(terms + k + q, &rest, sizeof rest);
            left += magnitudes(rest);
        }
    parts[0] = total(high - from_high);
    parts[1] = total(low - from_low);
    return total(left);
}

const array_ops ARRAY_OPS = {combine, square, drift, kick, stretch, magnitude, split};
