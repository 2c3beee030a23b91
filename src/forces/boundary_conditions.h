/* SPDX-License-Identifier: BSD-3-Clause */
/* What is done to nodes from outside: components of their motion that are prescribed, and forces on them, both as
 * functions of time that are known beforehand (docs/method.md, Boundary conditions). */
#ifndef DEM_FORCES_BOUNDARY_CONDITIONS_H
#define DEM_FORCES_BOUNDARY_CONDITIONS_H

#include <stdbool.h>

#include "base/exact_terms.h"
#include "base/vec2.h"
#include "domain/domain.h"
#include "forces/load_clock.h"

/** A condition as the caller gave it, with arrays of its own. */
typedef struct boundary_condition {
    dem_boundary_kind kind;
    int32_t components;
    vec2 value;
    double ramp;       /* s */
    dem_index n_nodes; /* of this rank */
    dem_index n_all;   /* with common nodes of other ranks behind them, which do not count here */
    dem_index *nodes;  /* [n_all] */
    double *share;     /* [n_all] of a force; else NULL */
} boundary_condition;

/** A share of a force on a node. The shares on one node are a linked list. */
typedef struct boundary_condition_share {
    dem_index boundary, next; /* next: -1 at the end */
    double share;
} boundary_condition_share;

typedef struct boundary_conditions {
    dem_index n;
    boundary_condition *list;         /* [n] */
    dem_index *first;                 /* [n_nodes] the first share on each node, -1: none; NULL: no forces at all */
    boundary_condition_share *pushes; /* one for each node of each force */
    unsigned char *held;              /* [n_nodes] components that are prescribed; NULL: no conditions */
    load_clock clock;                 /* of the ramps */
} boundary_conditions;

/** Validates and copies. Of a domain (else NULL), nodes are given by their numbers in the whole lattice, and what is
 *  compiled has those only that are integrated here. Free with boundary_conditions_free().
 *  \return DEM_ERROR_ARGUMENT; or DEM_ERROR_MODEL for a node that is fixed, whose component is prescribed twice, or
 *  that may
 *          touch one of `n_obstacles` obstacles */
dem_status boundary_conditions_compile(boundary_conditions *out, const dem_boundary *list, dem_index n,
                                       const dem_lattice *lattice, const domain *d, dem_index n_obstacles);
void boundary_conditions_free(boundary_conditions *b);

/* Of one condition, t is the time of the ramps; of all conditions, that of the motion. */

/** The factor of the condition at t, from 0 to 1 (base/ramp.h); 1 without a ramp. */
double boundary_condition_ramp(const boundary_condition *b, double t);

/** Velocity, m/s, and acceleration, m/s^2, of prescribed components at t. */
vec2 boundary_condition_velocity(const boundary_condition *b, double t);
vec2 boundary_condition_acceleration(const boundary_condition *b, double t);

/** Displacement of prescribed components by time t, m. */
vec2 boundary_condition_displacement(const boundary_condition *b, double t);

/** Acceleration, m/s^2, of the components that one of all conditions prescribes, and the whole force that one puts on
 *  its nodes, N. */
vec2 boundary_conditions_acceleration(const boundary_conditions *all, const boundary_condition *b, double t);
vec2 boundary_conditions_push(const boundary_conditions *all, const boundary_condition *b, double t);

/** Force on node i at t, N. */
vec2 boundary_conditions_force(const boundary_conditions *b, dem_index i, double t);

/** The derivative of a state, and what conditions put into that. */
typedef struct boundary_derivative {
    double *f, *a;      /* [n_nodes][2] velocities, accelerations */
    exact_terms *power; /* W: that of the reactions and of forces given */
} boundary_derivative;

/** Puts the prescribed components into the derivative, and adds the powers that the conditions put in at each node. */
void boundary_conditions_prescribe(const boundary_conditions *b, const double *mass, double t, const double *v,
                                   const boundary_derivative *to);

/** Puts the prescribed velocities at t into v [n_nodes][2].
 *  \param energy  the kinetic energy that this adds on this rank is added to it, J */
void boundary_conditions_give_velocities(const boundary_conditions *b, const double *mass, double t, double *v,
                                         exact_sum *energy);

/** Whether one of the conditions prescribes motions. */
bool boundary_conditions_move(const boundary_conditions *b);

/** The largest speed of a component that a condition prescribes, m/s. */
double boundary_conditions_speed(const boundary_conditions *b);

#endif
