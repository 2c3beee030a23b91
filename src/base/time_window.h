/* SPDX-License-Identifier: BSD-3-Clause */
/* Spans of time of one length, counted from t = 0, each of which begins with the first instant in it that is looked
 * at. */
#ifndef DEM_BASE_TIME_WINDOW_H
#define DEM_BASE_TIME_WINDOW_H

#include <math.h>
#include <stdbool.h>

/** Whether t, s, is in a later span than `before`; -INFINITY: before all of them.
 *  \param length  s, > 0 */
static inline bool time_window_begins(double length, double before, double t)
{
    return floor(t / length) > floor(before / length);
}

#endif
