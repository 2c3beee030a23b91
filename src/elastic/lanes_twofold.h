/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums of vectors with twice the digits of a double (base/twofold.h), lane by lane. A file of lanes comes first. */
#ifndef DEM_ELASTIC_LANES_TWOFOLD_H
#define DEM_ELASTIC_LANES_TWOFOLD_H

#include "base/twofold.h"
#include "elastic/layout.h"

#define INLINE static inline __attribute__((always_inline)) /* sums stay in registers */

typedef struct lanes_twofold {
    lanes high, low;
} lanes_twofold;

/* Sums of the two components. */
typedef struct pairs_twofold {
    pairs high, low;
} pairs_twofold;

INLINE lanes_twofold lanes_twofold_none(void)
{
    return (lanes_twofold){lanes_all(0.0), lanes_all(0.0)};
}

INLINE void lanes_twofold_add(lanes_twofold *s, lanes term)
{
    const lanes sum = lanes_add(s->high, term), kept = lanes_sub(sum, s->high);
    const lanes rest = lanes_add(lanes_sub(s->high, lanes_sub(sum, kept)), lanes_sub(term, kept));
    s->low = lanes_add(s->low, rest);
    s->high = sum;
}

INLINE pairs_twofold pairs_twofold_none(void)
{
    return (pairs_twofold){pairs_both(0.0, 0.0), pairs_both(0.0, 0.0)};
}

INLINE void pairs_twofold_add(pairs_twofold *s, pairs term)
{
    const pairs sum = pairs_add(s->high, term), kept = pairs_sub(sum, s->high);
    const pairs rest = pairs_add(pairs_sub(s->high, pairs_sub(sum, kept)), pairs_sub(term, kept));
    s->low = pairs_add(s->low, rest);
    s->high = sum;
}

/* Adds the lanes of a sum to another sum, in their order. */
INLINE void lanes_twofold_join(const lanes_twofold *s, twofold *to)
{
    double high[LAYOUT_LANES], low[LAYOUT_LANES];
    lanes_store(high, s->high);
    lanes_store(low, s->low);
    for (int k = 0; k < LAYOUT_LANES; k++) twofold_join(to, (twofold){high[k], low[k]});
}

/* The same of each component. */
INLINE void pairs_twofold_join(const pairs_twofold *s, twofold to[2])
{
    double high[2 * LAYOUT_LANES], low[2 * LAYOUT_LANES];
    pairs_store(high, s->high);
    pairs_store(low, s->low);
    for (int k = 0; k < 2 * LAYOUT_LANES; k++) twofold_join(&to[k % 2], (twofold){high[k], low[k]});
}

#endif
