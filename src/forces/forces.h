/* SPDX-License-Identifier: BSD-3-Clause */
/* What acts on the nodes of one simulation, contact with obstacles apart: force and acceleration of a node, the nodes
 * that these depend on, their power, and their energy. Here each node is computed for itself; the sweep over all nodes
 * (kernel.c) and the springs near an event (local_springs.c) evaluate the same terms, the sweep with equal bits.
 *
 * A further law gets files of its own and a pointer in `forces`, which is NULL where there is none; boundary conditions
 * (forces_push) and the contact of surfaces are the examples. The law adds
 *   - its force on a node to forces_own_acceleration(), and the nodes on which it acts to the rows that kernel.c
 *     evaluates one by one behind the sweep (accelerate_rest), which gives the sweep the same bits; or it is added to
 *     what the sweep has left, as that of surfaces (push_surfaces);
 *   - the nodes that this force depends on to forces_next_neighbour(), such that they hold for a whole step;
 *   - its energy to forces_node_energy() and diagnostics_energy(), or else its power to forces_node_power() and the
 *     sums over all nodes below it;
 *   - its dependence on time or velocities to the predicates that follow: forces_are_plain() is false with it.
 * Nothing outside this folder has to change. tests/unit/forces/test_forces.c tests what every law has to fulfil. */
#ifndef DEM_FORCES_FORCES_H
#define DEM_FORCES_FORCES_H

#include "forces/boundary_conditions.h"
#include "forces/external_force.h"
#include "model/element_state.h"
#include "model/model.h"
#include "surface_contact/rigid_contact.h"
#include "surface_contact/surface_contact.h"

/** The laws of one simulation. Springs and triangles belong to the model, which many simulations may share. */
typedef struct forces {
    const dem_model *model;
    const element_state *elements;         /* NULL: all springs and triangles are whole */
    double gravity[2];                     /* m/s^2 */
    double mass_damping;                   /* 1/s */
    const boundary_conditions *boundaries; /* NULL: none */
    surface_contact *surfaces;             /* NULL: bodies do not touch each other */
    rigid_contact *rigid;                  /* NULL: no rigid bodies, or nothing for them to meet */
    external_force *external;              /* NULL: none from outside */
    dem_index clock;                       /* index of the time among the velocities */
} forces;

/* ---- what it depends on ---- */

/** Whether there are forces on nodes that boundary conditions give. */
static inline bool forces_push(const forces *f)
{
    return f->boundaries != NULL && f->boundaries->first != NULL;
}

/** Whether any force depends on time. */
static inline bool forces_are_driven(const forces *f)
{
    return forces_push(f) || f->external != NULL || rigid_contact_is_driven(f->rigid);
}

/** Whether the force on a node depends on the velocities of its neighbours. */
static inline bool forces_couple_velocities(const forces *f)
{
    return f->model->springs.viscosity_of != NULL;
}

/** Whether bodies have friction with each other. */
static inline bool forces_have_friction(const forces *f)
{
    return surface_contact_has_friction(f->surfaces);
}

/** Whether springs or masses are damped. */
static inline bool forces_are_damped(const forces *f)
{
    return forces_couple_velocities(f) || f->mass_damping > 0.0;
}

/** Whether undamped springs that do not soften are all that acts between nodes, contact of surfaces apart, and
 *  forces_own_acceleration() does not depend on time. */
static inline bool forces_are_plain(const forces *f)
{
    const triangles *t = &f->model->triangles;
    return !forces_couple_velocities(f) && t->row[t->n_nodes] == 0 && f->model->couplings.n == 0 &&
           f->model->lattice.softening == NULL && !forces_push(f);
}

/** Whether forces_node_power() may be other than 0. */
static inline bool forces_have_power(const forces *f)
{
    return forces_are_damped(f) || f->boundaries != NULL || f->external != NULL || forces_have_friction(f);
}

/** Components of the motion of node i that are prescribed. */
static inline unsigned forces_held(const forces *f, dem_index i)
{
    return f->boundaries != NULL ? f->boundaries->held[i] : 0;
}

/** Goes through the nodes on which the force on one node depends: the other ends of its springs, then the other corners
 *  of its triangles, of elements that are whole, then the nodes of its contact pairs, itself included. Corners are left
 *  out where all of them are other ends already, and couplings add none, as every edge of a coupled triangle is a
 *  spring. Some nodes come more than once. */
typedef struct forces_neighbours {
    const forces *f;
    const element_state *state;    /* NULL: the elements of the node are whole */
    const int32_t *other, *others; /* ends of springs that are to come, and where they end */
    dem_index corner, corners;     /* the same of corners, two to each slot of a triangle */
    surface_neighbours surface;    /* the same of contact pairs */
    dem_index node;                /* the present one */
} forces_neighbours;

/* Begins; forces_next_neighbour() gives the first one. */
static inline forces_neighbours forces_neighbours_of(const forces *f, dem_index i)
{
    const springs *s = &f->model->springs;
    const int32_t *t = f->model->triangles.row + i;
    const element_state *state = element_state_at(f->elements, i);
    return (forces_neighbours){.f = f,
                               .state = state,
                               .other = s->neighbour + s->row[i],
                               .others = s->neighbour + s->row[i + 1],
                               .corner = 2 * t[0],
                               .corners = 2 * t[state == NULL && f->model->edges_are_springs ? 0 : 1],
                               .surface = surface_contact_neighbours(f->surfaces, i)};
}

/** Goes to the next one.  \return whether there is one */
static inline bool forces_next_neighbour(forces_neighbours *n)
{
    const springs *s = &n->f->model->springs;
    const triangles *t = &n->f->model->triangles;
    while (n->other < n->others) {
        n->node = *n->other++;
        if (!springs_is_broken(element_state_springs(n->state), s->spring[n->other - 1 - s->neighbour])) return true;
    }
    while (n->corner < n->corners) {
        const dem_index p = n->corner / 2;
        n->node = (n->corner++ & 1 ? t->last : t->next)[p];
        if (n->state == NULL || !n->state->triangle[t->triangle[p]]) return true;
    }
    return surface_contact_next_neighbour(&n->surface, &n->node);
}

/** Whether these are the other ends of the springs of node i alone, all of which are whole. */
static inline bool forces_neighbours_are_ends(const forces *f, dem_index i)
{
    const int32_t *t = f->model->triangles.row + i;
    return element_state_at(f->elements, i) == NULL && (f->model->edges_are_springs || t[0] == t[1]) &&
           !surface_contact_has(f->surfaces, i);
}

/* ---- accelerations ---- */

/* Force of the elements that are whole. `state` is NULL if all are: as a constant, so that compilers drop the tests. */
static inline vec2 forces_of_whole_elements(const forces *f, const element_state *state, dem_index i, const double *x,
                                            const double *v)
{
    const springs *s = &f->model->springs;
    const triangles *t = &f->model->triangles;
    vec2 bonds = springs_force(s, element_state_springs(state), i, x);
    if (f->model->couplings.n > 0)
        bonds = couplings_add_force(&f->model->couplings, element_state_triangles(state), i, x, bonds);
    if (s->viscosity_of != NULL) bonds = vec2_add(bonds, springs_damping(s, element_state_springs(state), i, x, v));
    if (t->row[i] == t->row[i + 1]) return bonds;
    return vec2_add(bonds, triangles_force(t, element_state_triangles(state), i, x));
}

/** forces_of_elements() of a node at which something is broken. */
vec2 forces_of_damaged(const forces *f, dem_index i, const double *x, const double *v);

/** Force of springs, area term and guard on node i at positions x and velocities v [n][2], N: (1) and its damping. */
static inline vec2 forces_of_elements(const forces *f, dem_index i, const double *x, const double *v)
{
    if (element_state_at(f->elements, i) != NULL) return forces_of_damaged(f, i, x, v);
    return forces_of_whole_elements(f, NULL, i, x, v);
}

/** Acceleration of node i, m/s^2, by a given force on it and its weight (2). A fixed node has none. */
static inline vec2 forces_undamped_acceleration(const forces *f, dem_index i, vec2 force)
{
    const double inverse_mass = f->model->inverse_mass[i];
    if (inverse_mass == 0.0) return (vec2){0.0, 0.0};
    return vec2_along((vec2){f->gravity[0], f->gravity[1]}, inverse_mass, force);
}

/** The same with the drag of its mass at velocity v. */
static inline vec2 forces_acceleration_by(const forces *f, dem_index i, vec2 force, vec2 v)
{
    if (f->model->inverse_mass[i] == 0.0) return (vec2){0.0, 0.0};
    return vec2_along(forces_undamped_acceleration(f, i, force), -f->mass_damping, v);
}

/** The same by the force of its elements, with what boundary conditions give. */
static inline vec2 forces_acceleration_of(const forces *f, dem_index i, vec2 elements, vec2 vi, const double *v)
{
    if (forces_push(f)) elements = vec2_add(elements, boundary_conditions_force(f->boundaries, i, v[f->clock]));
    return forces_acceleration_by(f, i, elements, vi);
}

/** Acceleration of node i, m/s^2, by its body alone: its elements, its weight, its drag, and what boundary conditions
 *  give. A fixed node has none. */
static inline vec2 forces_body_acceleration(const forces *f, dem_index i, const double *x, const double *v)
{
    return forces_acceleration_of(f, i, forces_of_elements(f, i, x, v), vec2_at(v, i), v);
}

/** An acceleration with a further force, N, added: a + f/m. */
static inline vec2 forces_with(const forces *f, dem_index i, vec2 own, vec2 further)
{
    return vec2_along(own, f->model->inverse_mass[i], further);
}

/** An acceleration with the contact of surfaces added. */
static inline vec2 forces_with_surfaces(const forces *f, dem_index i, vec2 own, const double *x)
{
    vec2 push;
    if (!surface_contact_has(f->surfaces, i) || !surface_contact_force(f->surfaces, i, x, &push)) return own;
    return forces_with(f, i, own, push);
}

/** Acceleration of node i, m/s^2, free of contact with obstacles and of the external force: (4). */
static inline vec2 forces_own_acceleration(const forces *f, dem_index i, const double *x, const double *v)
{
    return forces_with_surfaces(f, i, forces_body_acceleration(f, i, x, v), x);
}

/** Acceleration of node i, m/s^2, free of contact with obstacles, with the external force. */
static inline vec2 forces_acceleration(const forces *f, dem_index i, const double *x, const double *v)
{
    const vec2 a = forces_own_acceleration(f, i, x, v);
    if (f->external == NULL) return a;
    double force[2];
    external_force_of_node(f->external, v[f->clock], i, x + 2 * i, v + 2 * i, force);
    return forces_with(f, i, a, vec2_at(force, 0));
}

/** Puts the prescribed components at t into velocities u and accelerations a [n_nodes][2]; v has the velocities. The
 *  external force must have been evaluated for all nodes.
 *  \return the power, W, of the reactions, the given forces and the external force */
double forces_prescribe(const forces *f, double t, const double *v, double *u, double *a);

/* ---- power and energy ---- */

/** Powers, W. */
typedef struct forces_power {
    double damping;  /* taken by springs and masses */
    double work;     /* put in by boundary conditions and from outside */
    double friction; /* taken by that of bodies with each other, stored and lost */
} forces_power;

/** Power of the forces on node i, of which `external` N is the external one. The reaction of a prescribed component
 *  counts without the part m a.v of its own acceleration a. With that, the sums over all nodes are
 *  forces_damping_power(), what forces_prescribe() returns and forces_friction_power(), to rounding. */
forces_power forces_node_power(const forces *f, dem_index i, vec2 external, const double *x, const double *v);

/** Power that damping takes, of all springs and masses, W, >= 0. */
double forces_damping_power(const forces *f, const double *x, const double *v);

/** Takes part in the sums of other ranks that evaluate forces_prescribe() and then forces_damping_power(). */
void forces_sum_nothing(const forces *f);

/** Power that friction of bodies with each other takes, W. */
double forces_friction_power(const forces *f, const double *x, const double *v);

/** The same in the state of which all accelerations were computed last. */
static inline double forces_evaluated_friction_power(const forces *f, const double *v)
{
    return forces_have_friction(f) ? surface_contact_evaluated_power(f->surfaces, v) : 0.0;
}

/** Energy that depends on the position of node i, J: that of its springs and their couplings, its triangles, its
 *  contact pairs and its weight. What springs of friction store is not in it: it counts as taken by friction. */
static inline double forces_node_energy(const forces *f, dem_index i, const double *x)
{
    const dem_model *model = f->model;
    const double weight = model->lattice.mass[i] * vec2_dot(vec2_at(f->gravity, 0), vec2_at(x, i));
    const element_state *state = element_state_at(f->elements, i);
    const double own = springs_node_energy(&model->springs, element_state_springs(state), i, x) +
                       couplings_node_energy(&model->couplings, element_state_triangles(state), i, x) +
                       triangles_node_energy(&model->triangles, element_state_triangles(state), i, x) - weight;
    return surface_contact_has(f->surfaces, i) ? own + surface_contact_node_energy(f->surfaces, i, x) : own;
}

#endif
