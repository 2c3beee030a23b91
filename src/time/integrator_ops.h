/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of functions that an integrator consists of; each file of a method has one. integrator.c calls through
 * it. */
#ifndef DEM_TIME_INTEGRATOR_OPS_H
#define DEM_TIME_INTEGRATOR_OPS_H

#include <stdbool.h>

#include "time/ode_problem.h"

/** See integrator.h for what each does; `self` is what create() gave. */
typedef struct integrator_ops {
    dem_status (*create)(void **self, const ode_problem *problem, double t, const double *y);
    void (*destroy)(void *self); /* NULL is allowed */
    dem_status (*step)(void *self, dense_output *step, bool *rooted);
    bool (*take_unseen)(void *self, int n, double *ends, dense_output *last); /* NULL where there are none */
    void (*end)(void *self, double **y1, double **f1);
    dem_status (*redo)(void *self, double factor); /* NULL where steps are always fixed */
    void (*settle)(void *self, const dense_output *step);
    double *(*state)(const void *self);
    dem_status (*bound)(void *self, double longest);
    dem_status (*resume)(void *self);
    dem_status (*restart)(void *self, double t, const double *y);
    double (*next_step)(const void *self);
    dem_status (*renew)(void *self, const integrator_start *from);
    dem_counts (*counts)(const void *self);
} integrator_ops;

#endif
