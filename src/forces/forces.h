/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on the nodes of one simulation, node by node. The sweep over all nodes (kernel.c) gives the same bits. */
#ifndef DEM_FORCES_FORCES_H
#define DEM_FORCES_FORCES_H

#include "forces/boundary_conditions.h"
#include "forces/external_force.h"
#include "model/model.h"

/** Springs and triangles of the model, and what acts besides. It belongs to a simulation, the model to many. */
typedef struct forces {
    const dem_model *model;
    double gravity[2];                     /* m/s^2 */
    double mass_damping;                   /* 1/s */
    const boundary_conditions *boundaries; /* NULL: no forces on nodes */
    external_force *external;              /* NULL: none from outside */
    dem_index clock;                       /* where the time stands among the velocities */
} forces;

/** Whether any of it depends on time. */
static inline bool forces_are_driven(const forces *f)
{
    return f->boundaries != NULL || f->external != NULL;
}

/** Force of springs, area term and guard on node i at positions x and velocities v [n][2], N: (1) and its damping. */
static inline vec2 forces_of_elements(const forces *f, dem_index i, const double *x, const double *v)
{
    const dem_model *model = f->model;
    vec2 bonds = springs_force(&model->springs, i, x);
    if (model->springs.viscosity != NULL) bonds = vec2_add(bonds, springs_damping(&model->springs, i, x, v));
    if (model->triangles.row[i] == model->triangles.row[i + 1]) return bonds;
    return vec2_add(bonds, triangles_force(&model->triangles, i, x));
}

/** Acceleration of node i, m/s^2, free of contact: (4), weight (2) included, without forces from outside. A fixed node
 *  has none. */
static inline vec2 forces_own_acceleration(const forces *f, dem_index i, const double *x, const double *v)
{
    const double inverse_mass = f->model->inverse_mass[i];
    if (inverse_mass == 0.0) return (vec2){0.0, 0.0};
    const vec2 drag = vec2_scale(-f->mass_damping, vec2_at(v, i));
    vec2 force = forces_of_elements(f, i, x, v);
    if (f->boundaries != NULL) force = vec2_add(force, boundary_conditions_force(f->boundaries, i, v[f->clock]));
    const vec2 a = vec2_along((vec2){f->gravity[0], f->gravity[1]}, inverse_mass, force);
    return vec2_add(a, drag);
}

/** All of it. */
static inline vec2 forces_acceleration(const forces *f, dem_index i, const double *x, const double *v)
{
    const vec2 a = forces_own_acceleration(f, i, x, v);
    if (f->external == NULL) return a;
    const vec2 force = external_force_of_node(f->external, v[f->clock], i, vec2_at(x, i), vec2_at(v, i));
    return vec2_along(a, f->model->inverse_mass[i], force);
}

/** Energy that hangs on the position of node i, J: its springs, its triangles and its weight. */
static inline double forces_node_energy(const forces *f, dem_index i, const double *x)
{
    const dem_model *model = f->model;
    const double weight = model->lattice.mass[i] * (f->gravity[0] * x[2 * i] + f->gravity[1] * x[2 * i + 1]);
    return springs_node_energy(&model->springs, i, x) + triangles_node_energy(&model->triangles, i, x) - weight;
}

#endif
