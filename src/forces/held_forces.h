/* SPDX-License-Identifier: BSD-3-Clause */
/* The external force on the nodes with prescribed components, at one state. The reaction of a prescribed motion
 * contains it, so dem_simulation_boundary() needs it. It is evaluated beforehand, when a state is about to be shown,
 * because a query of a simulation must not call the program's function. */
#ifndef DEM_FORCES_HELD_FORCES_H
#define DEM_FORCES_HELD_FORCES_H

#include "base/state.h"
#include "forces/boundary_conditions.h"
#include "forces/external_force.h"

typedef struct held_forces {
    dem_index n;      /* nodes; 0 without an external force or without prescribed components */
    dem_index *nodes; /* [n] ascending */
    double *x, *v;    /* [n][dim] m, m/s, where it is asked for */
    double *asked;    /* [n][dim] N, what was answered */
    double *force;    /* [n_nodes][dim] N, of these nodes; NULL for n = 0 */
} held_forces;

/** \param external  may be NULL.  Free with held_forces_destroy(). */
dem_status held_forces_create(held_forces *out, const boundary_conditions *b, const external_force *external,
                              const state_layout *layout);
void held_forces_destroy(held_forces *h);

/** Asks for the force in a state y, in one query. */
void held_forces_ask(held_forces *h, external_force *external, const state_layout *layout, const double *y);

#endif
