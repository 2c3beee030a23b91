/* SPDX-License-Identifier: BSD-3-Clause */
/* Power: of one node, each force times its velocity; of all nodes, summed spring by spring and boundary by boundary. */
#include "forces/forces.h"

vec2 forces_of_damaged(const forces *f, dem_index i, const double *x, const double *v)
{
    return forces_of_whole_elements(f, f->elements, i, x, v);
}

double forces_prescribe(const forces *f, double t, const double *v, double *u, double *a)
{
    const double *mass = f->model->lattice.mass;
    const double work = f->boundaries != NULL ? boundary_conditions_prescribe(f->boundaries, mass, t, v, u, a) : 0.0;
    return f->external != NULL ? work + external_force_power(f->external, v) : work;
}

forces_power forces_node_power(const forces *f, dem_index i, vec2 external, const double *x, const double *v)
{
    const dem_model *model = f->model;
    const double mass = model->lattice.mass[i];
    const vec2 vi = vec2_at(v, i);
    const unsigned char *broken = element_state_springs(element_state_at(f->elements, i));
    forces_power power = {model->inverse_mass[i] > 0.0 ? f->mass_damping * mass * vec2_dot(vi, vi) : 0.0, 0.0};
    if (forces_couple_velocities(f)) power.damping -= vec2_dot(springs_damping(&model->springs, broken, i, x, v), vi);
    if (forces_push(f)) power.work += vec2_dot(boundary_conditions_force(f->boundaries, i, v[f->clock]), vi);
    if (f->external != NULL) power.work += vec2_dot(external, vi);
    const unsigned held = forces_held(f, i);
    if (held == 0) return power;
    const vec2 a = forces_with_external(f, i, forces_own_acceleration(f, i, x, v), external);
    if (held & DEM_COMPONENT_X) power.work -= mass * a.x * vi.x;
    if (held & DEM_COMPONENT_Y) power.work -= mass * a.y * vi.y;
    return power;
}

double forces_damping_power(const forces *f, const double *x, const double *v)
{
    const dem_model *model = f->model;
    double twice_kinetic = 0.0; /* of the nodes that move */
    if (!forces_are_damped(f)) return 0.0;
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        const vec2 vi = vec2_at(v, i);
        if (model->inverse_mass[i] > 0.0) twice_kinetic += model->lattice.mass[i] * vec2_dot(vi, vi);
    }
    return springs_damping_power(&model->springs, element_state_springs(f->elements), x, v) +
           f->mass_damping * twice_kinetic;
}
