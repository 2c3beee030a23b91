/* SPDX-License-Identifier: BSD-3-Clause */
/* The compiled, immutable problem: nodes, springs in CSR, triangles, obstacles; and the force on a node. */
#ifndef DEM_MODEL_H
#define DEM_MODEL_H

#include "boundary.h"
#include "coupling.h"
#include "layout.h"
#include "obstacle.h"
#include "springs.h"
#include "stress.h"
#include "surface.h"
#include "triangles.h"

struct dem_model {
    dem_lattice lattice; /* own copy; flags, body, position and velocity always filled */
    springs springs;
    triangles triangles;
    surface surface; /* edges that may touch */
    stress_map stress;
    layout layout; /* of springs and triangles, for sweeps over all nodes */
    obstacle_set obstacles;
    double *inverse_mass; /* [n_nodes] 1/kg; 0 where the node is fixed */
    dem_index n_sites;
    dem_index *sites; /* [n_sites] nodes that may touch, ascending */
    dem_index n_bodies;
    double spacing;   /* m */
    double omega_max; /* rad/s */
    double mass;      /* kg */
};

/** What acts on every node besides springs and triangles. */
typedef struct model_load {
    double gravity[2];            /* m/s^2 */
    double mass_damping;          /* 1/s */
    const boundaries *boundaries; /* NULL: no forces on nodes */
    coupling *coupling;           /* NULL: none from outside */
    dem_index clock;              /* where the time stands among the velocities */
} model_load;

/** Whether any of it depends on time. */
static inline bool model_is_driven(const model_load *load)
{
    return load->boundaries != NULL || load->coupling != NULL;
}

/** Force of springs, area term and guard on node i at positions x and velocities v [n][2], N: (1) and its damping. */
static inline vec2 model_force(const dem_model *model, dem_index i, const double *x, const double *v)
{
    vec2 bonds = springs_force(&model->springs, i, x);
    if (model->springs.viscosity != NULL) bonds = vec2_add(bonds, springs_damping(&model->springs, i, x, v));
    if (model->triangles.row[i] == model->triangles.row[i + 1]) return bonds;
    return vec2_add(bonds, triangles_force(&model->triangles, i, x));
}

/** Acceleration of node i, m/s^2, free of contact: (4), weight (2) included, without forces from outside. A fixed node
 *  has none. */
static inline vec2 model_own_acceleration(const dem_model *model, const model_load *load, dem_index i, const double *x,
                                          const double *v)
{
    const double inverse_mass = model->inverse_mass[i];
    if (inverse_mass == 0.0) return (vec2){0.0, 0.0};
    const vec2 drag = vec2_scale(-load->mass_damping, vec2_at(v, i));
    vec2 force = model_force(model, i, x, v);
    if (load->boundaries != NULL) force = vec2_add(force, boundaries_force(load->boundaries, i, v[load->clock]));
    const vec2 a = vec2_along((vec2){load->gravity[0], load->gravity[1]}, inverse_mass, force);
    return vec2_add(a, drag);
}

/** All of it. */
static inline vec2 model_acceleration(const dem_model *model, const model_load *load, dem_index i, const double *x,
                                      const double *v)
{
    const vec2 a = model_own_acceleration(model, load, i, x, v);
    if (load->coupling == NULL) return a;
    const vec2 force = coupling_force(load->coupling, v[load->clock], i, vec2_at(x, i), vec2_at(v, i));
    return vec2_along(a, model->inverse_mass[i], force);
}

/** Energy that hangs on the position of node i, J: its springs, its triangles and its weight. */
double model_node_energy(const dem_model *model, const double gravity[2], dem_index i, const double *x);

#endif
