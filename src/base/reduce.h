/* SPDX-License-Identifier: BSD-3-Clause */
/* Reductions: every number and decision that concerns the whole model, although it is computed node by node. A run is
 * one process, so each function returns what it is given. If nodes were shared out among processes (ranks), this would
 * be the only place where they exchange numbers. The rules that this needs hold today:
 *   - every rank makes the same calls in the same order, so none stands in a loop over own nodes, candidates or events,
 *     nor behind a condition that is not the same for all;
 *   - what is the same for all anyway (options, obstacles, time, counts of steps) is not reduced;
 *   - what only saves a rank work of its own is not reduced.
 * docs/architecture.md lists the calls, and what is still missing. */
#ifndef DEM_BASE_REDUCE_H
#define DEM_BASE_REDUCE_H

#include "base/array_ops.h"
#include "base/exact_sum.h"

static inline double reduce_min(double own)
{
    return own;
}

static inline double reduce_max(double own)
{
    return own;
}

static inline bool reduce_any(bool own)
{
    return own;
}

/** The sum of counts; each item is counted by one rank. */
static inline dem_index reduce_count(dem_index own)
{
    return own;
}

/** The sum of all terms of all ranks, rounded once: its bits do not depend on which rank has which terms. */
static inline double reduce_sum(const exact_sum *own)
{
    return exact_sum_value(own);
}

/** The same of sums of squares. */
static inline array_ops_sum reduce_squares(array_ops_sum own)
{
    return own;
}

/** The least value, and the number `of` the item that has it (< 0: the rank has no item). Of equal values the one with
 *  the lowest key counts. */
static inline void reduce_least(double *value, dem_index *of, dem_index key)
{
    (void)value;
    (void)of;
    (void)key;
}

/** The same of the largest value. */
static inline void reduce_largest(double *value, dem_index *of, dem_index key)
{
    (void)value;
    (void)of;
    (void)key;
}

/** DEM_OK if all ranks have that. Otherwise the status and message of the failing rank with the lowest key, and of
 *  equal keys of the lowest rank. The key says when a single process would have failed: the time of an event, or 0
 *  where there is no order. A rank that is out of memory need not call this, since that ends the run. */
static inline dem_status reduce_status(dem_status own, double key)
{
    (void)key;
    return own;
}

#endif
