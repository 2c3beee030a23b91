/* SPDX-License-Identifier: BSD-3-Clause */
/* Power of the forces on the nodes, which the energy ledger integrates: taken by damping, put in by boundary conditions
 * and the external force (docs/method.md, Damping and The ledger). Of one node it is each force times its velocity; of
 * all nodes it is summed spring by spring and condition by condition, exactly. The forces themselves are inline in
 * forces.h. */
#include "forces/forces.h"

#include "base/reduce.h"

/* The rare case of a node with broken elements, kept out of line so that the usual one stays short. */
vec2 forces_of_damaged(const forces *f, dem_index i, const double *x, const double *v)
{
    return forces_of_whole_elements(f, f->elements, i, x, v);
}

static bool have_work(const forces *f)
{
    return f->boundaries != NULL || f->external != NULL;
}

/* The external force has been evaluated for all nodes before; its power is added to that of the conditions. */
double forces_prescribe(const forces *f, double t, const double *v, double *u, double *a)
{
    const double *mass = f->model->lattice.mass;
    exact_sum work = {0};
    exact_terms terms;
    if (!have_work(f)) return 0.0;
    exact_terms_begin(&terms, &work);
    if (f->boundaries != NULL)
        boundary_conditions_prescribe(f->boundaries, mass, t, v, &(boundary_derivative){u, a, &terms});
    if (f->external != NULL) external_force_add_power(f->external, v, &terms);
    exact_terms_end(&terms);
    return reduce_sum(f->model->ranks, &work);
}

/* Damping takes alpha m v^2 and -F.v of the viscous forces F on this node; over both ends of a spring the latter adds
 * up to c e'^2 d0. The work is F.v of the forces given. The reaction of a prescribed component is m (a - a_free), of
 * which -m a_free is counted here, and the part with the prescribed acceleration a is left to the caller. */
forces_power forces_node_power(const forces *f, dem_index i, vec2 external, const double *x, const double *v)
{
    const dem_model *model = f->model;
    const double mass = model->lattice.mass[i];
    const vec2 vi = vec2_at(v, i);
    const springs_integrity integrity = element_state_springs(element_state_at(f->elements, i));
    forces_power power = {.damping = model->inverse_mass[i] > 0.0 ? f->mass_damping * mass * vec2_dot(vi, vi) : 0.0};
    if (forces_have_friction(f)) power.friction = -vec2_dot(surface_contact_friction(f->surfaces, i, x), vi);
    if (forces_couple_velocities(f))
        power.damping -= vec2_dot(springs_damping(&model->springs, integrity, i, x, v), vi);
    if (forces_push(f)) power.work += vec2_dot(boundary_conditions_force(f->boundaries, i, v[f->clock]), vi);
    if (f->external != NULL) power.work += vec2_dot(external, vi);
    /* Most nodes end here. The free acceleration of the others is computed anew, with the external force in it. */
    const unsigned held = forces_held(f, i);
    if (held == 0) return power;
    const vec2 a = forces_with(f, i, forces_own_acceleration(f, i, x, v), external);
    if (held & DEM_COMPONENT_X) power.work -= mass * a.x * vi.x;
    if (held & DEM_COMPONENT_Y) power.work -= mass * a.y * vi.y;
    return power;
}

/* alpha m v^2 of each own node that moves. */
static void add_drag(const forces *f, const double *v, exact_terms *power)
{
    const dem_model *model = f->model;
    if (f->mass_damping == 0.0) return;
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        const vec2 vi = vec2_at(v, i);
        if (model->inverse_mass[i] > 0.0 && domain_owns(model->domain, i))
            exact_terms_add(power, f->mass_damping * model->lattice.mass[i] * vec2_dot(vi, vi));
    }
}

/* Viscous forces of springs. Of those that several ranks have the one counts that has the lower node as its own. */
static void add_springs(const forces *f, const double *x, const double *v, exact_terms *power)
{
    const dem_model *m = f->model;
    const springs_integrity integrity = element_state_springs(f->elements);
    for (dem_index i = 0, end; i < m->lattice.n_nodes; i = end) {
        const bool is_own = domain_run(m->domain, i, m->lattice.n_nodes, &end);
        if (is_own) springs_add_damping_power(&m->springs, integrity, (dem_index[]){i, end}, x, v, power);
    }
}

double forces_damping_power(const forces *f, const double *x, const double *v)
{
    exact_sum power = {0};
    exact_terms terms;
    if (!forces_are_damped(f)) return 0.0;
    exact_terms_begin(&terms, &power);
    add_springs(f, x, v, &terms);
    add_drag(f, v, &terms);
    exact_terms_end(&terms);
    return reduce_sum(f->model->ranks, &power);
}

void forces_sum_nothing(const forces *f)
{
    const exact_sum nothing = {0};
    if (f->external != NULL) external_force_pass_over(f->external);
    if (have_work(f)) (void)reduce_sum(f->model->ranks, &nothing);
    if (forces_are_damped(f)) (void)reduce_sum(f->model->ranks, &nothing);
}

double forces_friction_power(const forces *f, const double *x, const double *v)
{
    return forces_have_friction(f) ? surface_contact_friction_power(f->surfaces, x, v) : 0.0;
}
