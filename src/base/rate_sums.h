/* SPDX-License-Identifier: BSD-3-Clause */
/* Exact sums of what contacts add to the rates of the quadratures, so that neither the order of contacts matters nor
 * who adds first. */
#ifndef DEM_BASE_RATE_SUMS_H
#define DEM_BASE_RATE_SUMS_H

#include "base/exact_sum.h"
#include "base/state.h"

typedef struct rate_sums {
    exact_sum *list; /* of each component of the quadratures' rows; empty between uses */
} rate_sums;

/** \return DEM_ERROR_MEMORY. Free with rate_sums_free(). */
dem_status rate_sums_create(rate_sums *out, int dim, dem_index n_obstacles);
void rate_sums_free(rate_sums *s);

/** Adds a term to the rate at an index of accelerations (base/state.h). */
static inline void rate_sums_add(const rate_sums *s, const state_layout *l, dem_index index, double term)
{
    exact_sum_add(&s->list[index - state_row(l, state_impulse(l, 0))], term);
}

/** Adds to the rates of a row.  \param terms  [dim] */
static inline void rate_sums_add_row(const rate_sums *s, const state_layout *l, dem_index row, const double *terms)
{
    for (int d = 0; d < l->dim; d++) rate_sums_add(s, l, state_row(l, row) + d, terms[d]);
}

/** Adds a block of terms to the rate at an index, or in turns to that and the next one, as exact_sum_take() and
 *  exact_sum_take_pairs() do. */
static inline void rate_sums_add_terms(const rate_sums *s, const state_layout *l, dem_index index,
                                       double terms[EXACT_SUM_BLOCK], int n)
{
    exact_sum_take(&s->list[index - state_row(l, state_impulse(l, 0))], terms, n);
}

static inline void rate_sums_add_pairs(const rate_sums *s, const state_layout *l, dem_index index,
                                       double terms[EXACT_SUM_BLOCK], int n)
{
    exact_sum_take_pairs(&s->list[index - state_row(l, state_impulse(l, 0))], terms, n);
}

/** Adds the sums to the rates among the accelerations a, and empties them. Every rank has all terms. */
void rate_sums_take(const rate_sums *s, const state_layout *l, double *a);

#endif
