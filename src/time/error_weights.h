/* SPDX-License-Identifier: BSD-3-Clause */
/* What the numbers of a state weigh in the norm of its error: they are the same at all times, one for the positions of
 * the nodes that count here, one for their velocities, and practically none for all else. So they are kept as runs of
 * numbers with the same weight, and no vector of them exists. */
#ifndef DEM_TIME_ERROR_WEIGHTS_H
#define DEM_TIME_ERROR_WEIGHTS_H

#include "time/ode_problem.h"

typedef struct error_weights error_weights;

/** Of a state of the problem. NULL without memory. Free with error_weights_free(). */
error_weights *error_weights_create(const ode_problem *problem);
void error_weights_free(error_weights *w);

/** The weight of number k of a state. */
double error_weights_at(const error_weights *w, dem_index k);

/** A bound of the sum of |number times weight| of n numbers, which are those from `first` on; NAN or infinite if one of
 *  them is. */
double error_weights_bound(const error_weights *w, const double *x, dem_index first, dem_index n);

/** Adds the squares of scale times number times weight of n numbers, which are those from `first` on, to a sum. */
void error_weights_square(const error_weights *w, array_ops_sum *sum, const double *x, double scale, dem_index first,
                          dem_index n);

#endif
