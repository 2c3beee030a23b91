/* SPDX-License-Identifier: BSD-3-Clause */
/* Terms of an exact sum on their way to it: they are collected, as many together cost less than one by one. */
#ifndef DEM_BASE_EXACT_TERMS_H
#define DEM_BASE_EXACT_TERMS_H

#include "base/exact_sum.h"

enum { EXACT_TERMS_MOST = 256 };

/** {.n = 0} is the empty sum. */
typedef struct exact_terms {
    exact_sum sum; /* without those that wait */
    int n;         /* that wait */
    double waiting[EXACT_TERMS_MOST];
} exact_terms;

/** The sum of all terms so far. */
static inline const exact_sum *exact_terms_sum(exact_terms *t)
{
    exact_sum_add_array(&t->sum, t->waiting, t->n);
    t->n = 0;
    return &t->sum;
}

static inline void exact_terms_add(exact_terms *t, double term)
{
    t->waiting[t->n++] = term;
    if (t->n == EXACT_TERMS_MOST) (void)exact_terms_sum(t);
}

#endif
