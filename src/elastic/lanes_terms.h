/* SPDX-License-Identifier: BSD-3-Clause */
/* Terms of exact sums (base/exact_terms.h), eight at a time. A file of lanes comes first. */
#ifndef DEM_ELASTIC_LANES_TERMS_H
#define DEM_ELASTIC_LANES_TERMS_H

#include "base/exact_terms.h"
#include "base/inline.h"
#include "elastic/layout.h"

INLINE void lanes_terms_add(exact_terms *t, lanes terms)
{
    lanes_store(t->list + t->n, terms);
    t->n += LAYOUT_LANES;
    if (t->n == EXACT_SUM_BLOCK) exact_terms_end(t);
}

/* Adds what waits of pairs to two sums. */
INLINE void pairs_terms_end(exact_terms *t)
{
    exact_sum_take_pairs(t->to, t->list, t->n);
    t->n = 0;
}

/* Of two sums, one after another, from where the terms go. */
INLINE void pairs_terms_add(exact_terms *t, pairs terms)
{
    pairs_store(t->list + t->n, terms);
    t->n += 2 * LAYOUT_LANES;
    if (t->n == EXACT_SUM_BLOCK) pairs_terms_end(t);
}

#endif
