/* SPDX-License-Identifier: BSD-3-Clause */
/* The vectors of the sweep in C with the compiler's own vectors of two numbers, for any machine. */
#ifndef DEM_ELASTIC_LANES_PORTABLE_H
#define DEM_ELASTIC_LANES_PORTABLE_H

#include "base/inline.h"
#include "elastic/layout.h"

typedef double two __attribute__((vector_size(16)));
typedef int64_t two_bits __attribute__((vector_size(16)));

typedef struct pairs {
    two n[8]; /* of each node */
} pairs;

typedef struct lanes {
    two n[4]; /* of nodes 0 and 4, 1 and 5, ... */
} lanes;

#define EACH UNROLLED for (int k = 0; k < 8; k++)
#define HALF UNROLLED for (int k = 0; k < 4; k++)

INLINE two load_two(const double *p)
{
    return (two){p[0], p[1]};
}

INLINE pairs pairs_both(double x, double y)
{
    pairs a;
    EACH a.n[k] = (two){x, y};
    return a;
}

INLINE pairs pairs_load(const double *p)
{
    pairs a;
    EACH a.n[k] = load_two(p + 2 * k);
    return a;
}

INLINE void pairs_store(double *p, pairs a)
{
    EACH
    {
        p[2 * k] = a.n[k][0];
        p[2 * k + 1] = a.n[k][1];
    }
}

INLINE pairs pairs_gather(const double *array, const int32_t *index)
{
    pairs a;
    EACH a.n[k] = load_two(array + index[k]);
    return a;
}

INLINE pairs pairs_spread(const double *p)
{
    pairs a;
    EACH a.n[k] = (two){p[k], p[k]};
    return a;
}

/* All bits if node k is in the mask. */
INLINE two_bits spread_bit(unsigned mask, int k)
{
    const int64_t bits = -(int64_t)(mask >> (2 * k) & 1u);
    return (two_bits){bits, bits};
}

INLINE pairs pairs_mask(pairs a, unsigned mask)
{
    EACH a.n[k] = (two)((two_bits)a.n[k] & spread_bit(mask, k));
    return a;
}

/* Of the nodes in the mask. */
INLINE pairs pairs_negate(pairs a, unsigned mask)
{
    EACH a.n[k] = (two)((two_bits)a.n[k] ^ (spread_bit(mask, k) & (two_bits){INT64_MIN, INT64_MIN}));
    return a;
}

INLINE pairs pairs_unless_zero(pairs where, pairs a)
{
    EACH a.n[k] = where.n[k][0] != 0.0 ? a.n[k] : (two){0.0, 0.0};
    return a;
}

INLINE pairs pairs_swap(pairs a)
{
    EACH a.n[k] = (two){a.n[k][1], a.n[k][0]};
    return a;
}

INLINE pairs pairs_add(pairs a, pairs b)
{
    EACH a.n[k] += b.n[k];
    return a;
}

INLINE pairs pairs_sub(pairs a, pairs b)
{
    EACH a.n[k] -= b.n[k];
    return a;
}

INLINE pairs pairs_mul(pairs a, pairs b)
{
    EACH a.n[k] *= b.n[k];
    return a;
}

INLINE double pairs_total(pairs a)
{
    double sum = 0.0;
    EACH sum += a.n[k][0] + a.n[k][1];
    return sum;
}

INLINE pairs pairs_scale(lanes s, pairs a)
{
    HALF a.n[k] *= (two){s.n[k][0], s.n[k][0]};
    HALF a.n[k + 4] *= (two){s.n[k][1], s.n[k][1]};
    return a;
}

INLINE lanes pairs_dot(pairs a, pairs b)
{
    lanes c;
    const pairs p = pairs_mul(a, b);
    HALF c.n[k] = (two){p.n[k][0], p.n[k + 4][0]} + (two){p.n[k][1], p.n[k + 4][1]};
    return c;
}

INLINE lanes pairs_cross(pairs a, pairs b)
{
    lanes c;
    const pairs p = pairs_mul(a, pairs_swap(b));
    HALF c.n[k] = (two){p.n[k][0], p.n[k + 4][0]} - (two){p.n[k][1], p.n[k + 4][1]};
    return c;
}

INLINE lanes lanes_all(double value)
{
    lanes a;
    HALF a.n[k] = (two){value, value};
    return a;
}

INLINE lanes lanes_load(const double *p)
{
    lanes a;
    HALF a.n[k] = load_two(p + 2 * k);
    return a;
}

INLINE lanes lanes_add(lanes a, lanes b)
{
    HALF a.n[k] += b.n[k];
    return a;
}

INLINE lanes lanes_sub(lanes a, lanes b)
{
    HALF a.n[k] -= b.n[k];
    return a;
}

INLINE lanes lanes_mul(lanes a, lanes b)
{
    HALF a.n[k] *= b.n[k];
    return a;
}

INLINE lanes lanes_div(lanes a, lanes b)
{
    HALF a.n[k] /= b.n[k];
    return a;
}

INLINE lanes lanes_sqrt(lanes a)
{
    HALF a.n[k] = (two){sqrt(a.n[k][0]), sqrt(a.n[k][1])};
    return a;
}

/** Bit layout_lane(q) is that of node q. */
INLINE unsigned lanes_below(lanes a, lanes b)
{
    unsigned below = 0;
    HALF below |= (unsigned)(a.n[k][0] < b.n[k][0]) << (2 * k) | (unsigned)(a.n[k][1] < b.n[k][1]) << (2 * k + 1);
    return below;
}

static inline void lanes_store(double *p, lanes a)
{
    HALF
    {
        p[2 * k] = a.n[k][0];
        p[2 * k + 1] = a.n[k][1];
    }
}

/** a < b ? a : b */
static inline lanes lanes_min(lanes a, lanes b)
{
    HALF a.n[k] = (two){a.n[k][0] < b.n[k][0] ? a.n[k][0] : b.n[k][0], a.n[k][1] < b.n[k][1] ? a.n[k][1] : b.n[k][1]};
    return a;
}

/** a > b ? a : b */
static inline lanes lanes_max(lanes a, lanes b)
{
    HALF a.n[k] = (two){a.n[k][0] > b.n[k][0] ? a.n[k][0] : b.n[k][0], a.n[k][1] > b.n[k][1] ? a.n[k][1] : b.n[k][1]};
    return a;
}

/** a in the lanes that are chosen, by bits as in lanes_below(), b in the others. */
static inline lanes lanes_where(unsigned chosen, lanes a, lanes b)
{
    HALF b.n[k] =
        (two){chosen >> (2 * k) & 1u ? a.n[k][0] : b.n[k][0], chosen >> (2 * k + 1) & 1u ? a.n[k][1] : b.n[k][1]};
    return b;
}

/** a where `where` is not 0, else 0. */
static inline lanes lanes_unless_zero(lanes where, lanes a)
{
    HALF a.n[k] = (two){where.n[k][0] != 0.0 ? a.n[k][0] : 0.0, where.n[k][1] != 0.0 ? a.n[k][1] : 0.0};
    return a;
}

/** Of lanes in the order of memory the ones before: the last of `before`, and the first seven of a. */
INLINE lanes lanes_behind(lanes before, lanes a)
{
    lanes c;
    HALF c.n[k] = (two){k > 0 ? a.n[k - 1][1] : before.n[3][1], a.n[k][0]};
    return c;
}

/** And the ones behind: the last seven of a, and the first of `after`. */
INLINE lanes lanes_ahead(lanes a, lanes after)
{
    lanes c;
    HALF c.n[k] = (two){a.n[k][1], k < 3 ? a.n[k + 1][0] : after.n[0][0]};
    return c;
}

#undef EACH
#undef HALF

#endif
