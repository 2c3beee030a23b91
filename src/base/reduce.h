/* SPDX-License-Identifier: BSD-3-Clause */
/* Reductions: every number and decision that concerns the whole model, although it is computed node by node. Each takes
 * what a rank has of its own and returns what all of them have, the same on all to the bit, whatever the shares. The
 * rules that this needs:
 *   - every rank makes the same calls in the same order, so none stands in a loop over own nodes, candidates or events,
 *     nor behind a condition that is not the same for all;
 *   - what is the same for all anyway (options, obstacles, time, counts of steps) is not reduced;
 *   - what only saves a rank work of its own is not reduced.
 * docs/architecture.md lists the calls, and what is still missing. */
#ifndef DEM_BASE_REDUCE_H
#define DEM_BASE_REDUCE_H

#include "base/array_ops.h"
#include "base/exact_sum.h"
#include "base/ranks.h"

double reduce_min(const ranks *r, double own);

/** NAN is larger than any number. */
double reduce_max(const ranks *r, double own);

/** The larger of two as reduce_max() has it. */
static inline double reduce_larger(double a, double b)
{
    return !(b <= a) && a == a ? b : a;
}

bool reduce_any(const ranks *r, bool own);

/** Whether all ranks have the same number. */
bool reduce_alike(const ranks *r, uint64_t own);

/** The sum of counts; each item is counted by one rank. */
dem_index reduce_count(const ranks *r, dem_index own);

/** The same of n counts.  \param[in,out] counts  [n] */
void reduce_counts(const ranks *r, dem_index *counts, dem_index n);

/** The sum of all terms of all ranks, rounded once: its bits do not depend on which rank has which terms. */
double reduce_sum(const ranks *r, const exact_sum *own);

enum { REDUCE_SUMS_MOST = 8 };

/** Several sums, n of them, at once.  \param own  [n]  \param[out] values  [n] */
void reduce_sums(const ranks *r, const exact_sum *const *own, int n, double *values);

/** The same of sums of squares. */
array_ops_sum reduce_squares(const ranks *r, array_ops_sum own);

enum { REDUCE_REPORT_MOST = 8 };

/** Numbers that one rank has, and all get.  \param[in,out] values  [n] read where `is_here`, which it is on one rank */
void reduce_report(const ranks *r, bool is_here, double *values, int n);

/** DEM_OK if all ranks have that. Otherwise the status and message of the failing rank with the lowest key, and of
 *  equal keys of the lowest rank. The key says when a single process would have failed: the time of an event, or 0
 *  where there is no order. A rank that is out of memory need not call this, since that ends the run. */
dem_status reduce_status(const ranks *r, dem_status own, double key);

#endif
