/* SPDX-License-Identifier: BSD-3-Clause */
/* Every number and decision that is of the whole model though it is worked out node by node. A run is one process, so
 * each function returns what it is given; if the nodes were shared out among several (ranks), this would be the only
 * place where they talk to each other about numbers. The rules that this asks for hold today:
 * - every rank comes to the same calls in the same order, so none stands in a loop over own nodes, candidates or
 *   events, nor behind a condition that is not the same for all;
 * - what is the same for all anyway (options, obstacles, time, counts of steps) is not reduced;
 * - what only spares a rank work of its own is not reduced.
 * docs/algorithms.md lists the calls, and what is still missing. */
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

/** Sum of numbers of things, each of which is counted by one rank. */
static inline dem_index reduce_count(dem_index own)
{
    return own;
}

/** The sum of all terms of all ranks, rounded once: its bits do not depend on who has which. */
static inline double reduce_sum(const exact_sum *own)
{
    return exact_sum_value(own);
}

/** The same of sums of squares. */
static inline array_ops_sum reduce_squares(array_ops_sum own)
{
    return own;
}

/** Sum of what ranks have added up in doubles: its last digits depend on who has which terms, and in one process on
 *  their order. */
static inline double reduce_rounded_sum(double own)
{
    return own;
}

/** The least value and the number of what it is of, < 0 where a rank has none; of equal values the one with the lowest
 *  key counts. */
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

/** DEM_OK if it is that on all ranks, else the status, and the message with it, of the failing rank with the lowest
 *  key, which says when a single process would have failed: the time of an event, 0 where there is no order; of equal
 *  keys that of the lowest rank. A rank that is out of memory need not come here: it ends the run. */
static inline dem_status reduce_status(dem_status own, double key)
{
    (void)key;
    return own;
}

#endif
