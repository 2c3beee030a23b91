/* SPDX-License-Identifier: BSD-3-Clause */
/* Terms on their way to an exact sum: it takes many at once in a fraction of the time. */
#ifndef DEM_BASE_EXACT_TERMS_H
#define DEM_BASE_EXACT_TERMS_H

#include "base/exact_sum.h"

typedef struct exact_terms {
    exact_sum *to;
    int n; /* that wait */
    double list[EXACT_SUM_BLOCK];
} exact_terms;

/** The list is left as it is: to fill it with zeros would take as long as many a sum. */
static inline void exact_terms_begin(exact_terms *t, exact_sum *to)
{
    t->to = to;
    t->n = 0;
}

/** Adds what waits. */
static inline void exact_terms_end(exact_terms *t)
{
    exact_sum_take(t->to, t->list, t->n);
    t->n = 0;
}

static inline void exact_terms_add(exact_terms *t, double term)
{
    t->list[t->n++] = term;
    if (t->n == EXACT_SUM_BLOCK) exact_terms_end(t);
}

/** The exact sum of n products, each of which is rounded. */
static inline exact_sum exact_terms_product(const double *a, const double *b, int64_t n)
{
    exact_sum sum = {0};
    exact_terms terms;
    exact_terms_begin(&terms, &sum);
    for (int64_t k = 0; k < n; k++) exact_terms_add(&terms, a[k] * b[k]);
    exact_terms_end(&terms);
    return sum;
}

#endif
