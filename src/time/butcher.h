/* SPDX-License-Identifier: BSD-3-Clause */
/* The methods of integration by name: the coefficients of the Runge-Kutta ones, and what follows from them. */
#ifndef DEM_TIME_BUTCHER_H
#define DEM_TIME_BUTCHER_H

#include <stdbool.h>

#include <dem/dem.h>

#include "base/step_reach.h"

enum { BUTCHER_STAGES = 17 }; /* of the largest table */

/** Butcher's table of an explicit method:  k_i = f(t + c_i h, y + h sum of a_ij k_j),  y' = y + h sum of b_i k_i. */
typedef struct butcher_table {
    int stages;
    int order, embedded_order;                 /* of the weights b, and of d; 0: there are no d */
    double a[BUTCHER_STAGES * BUTCHER_STAGES]; /* [stages][stages] */
    double b[BUTCHER_STAGES], c[BUTCHER_STAGES], d[BUTCHER_STAGES];
} butcher_table;

/** Coefficients such that ARKODE of every version integrates them at their order.
 *  \return DEM_ERROR_ARGUMENT for an unknown method, one that this SUNDIALS does not have, and Verlet's, which has no
 *  table */
dem_status butcher_load(butcher_table *out, dem_method method);

/** The coefficients without a stage that only ARKODE needs. */
dem_status butcher_load_own(butcher_table *out, dem_method method);

/** Whether the last stage is the end of the step, so that the next step has its derivative. */
bool butcher_ends_in_stage(const butcher_table *t);

/** How many rings of neighbours about a node have a part in what it does in a step: in its place, its velocity and
 *  their errors at the end, and before in all that they depend on, but in the derivative at the end. Accelerations
 *  depend on the places of neighbours. */
int butcher_rings(const butcher_table *t);

/** The same of a method; 0: ghosts cannot be integrated through its steps. That is so with Verlet's, and where the last
 *  stage is the end of the step: ARKODE adds up the end once more behind its derivative, and ghosts are not those for
 *  which that is. */
int butcher_rings_of(dem_method method);

/** How far a step of any method reaches, Verlet's included.  \return DEM_ERROR_ARGUMENT as butcher_load() */
dem_status butcher_reach(step_reach *out, dem_method method);

#endif
