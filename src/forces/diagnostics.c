/* SPDX-License-Identifier: BSD-3-Clause */
/* What is measured on a state besides what survey.c measures of all nodes: energy of contact, reactions of obstacles
 * and boundary conditions, residual, the largest speed. Sums are exact, so that the numbers do not depend on the order
 * of contacts and nodes (docs/architecture.md, Numbers of the whole). Nothing here feeds back into the motion. What
 * damping and friction take is not measured but integrated with the motion (simulation/right_hand_side.c); impacts have
 * their ledger in contact/ledger.c. */
#include "forces/diagnostics.h"

#include "base/reduce.h"

/* Adds a vector to a pair of sums. */
static void add(exact_sum sum[2], vec2 term)
{
    exact_sum_add(&sum[0], term.x);
    exact_sum_add(&sum[1], term.y);
}

static vec2 sum_of(const ranks *r, const exact_sum sum[2])
{
    return (vec2){reduce_sum(r, &sum[0]), reduce_sum(r, &sum[1])};
}

/* In springs of friction of bodies with each other and of rigid bodies with obstacles, J. */
static double stored_by_friction(const forces *f, const double *x, double t)
{
    const double between = forces_have_friction(f) ? surface_contact_stored(f->surfaces, x) : 0.0;
    return rigid_contact_has_friction(f->rigid) ? between + rigid_contact_stored(f->rigid, t, x) : between;
}

dem_energy diagnostics_energy(const forces *f, const survey *s, const double *x, const double *v)
{
    dem_energy energy = {.kinetic = s->energies.kinetic,
                         .elastic = s->energies.elastic,
                         .area = s->energies.area,
                         .guard = s->energies.guard,
                         .gravity = s->energies.weight};
    energy.contact = f->surfaces != NULL ? surface_contact_energy(f->surfaces, x) : 0.0;
    if (f->rigid != NULL) energy.contact += rigid_contact_energy(f->rigid, v[f->clock], x);
    const double stored = stored_by_friction(f, x, v[f->clock]);
    energy.contact += stored;
    energy.friction = 0.0 - stored; /* of all that friction has taken this can be given back */
    energy.motion = energy.kinetic + energy.elastic + energy.area + energy.guard + energy.contact;
    return energy;
}

/* Force of a contact on the body, N n + T t with t = (n_y, -n_x), N. */
static vec2 contact_force(const dem_contact *c)
{
    const vec2 n = vec2_at(c->normal, 0), t = {n.y, -n.x};
    return vec2_along(vec2_scale(c->force, n), c->friction[0], t);
}

/* Forces at places, as a resultant and its line of action are found from them. */
typedef struct reaction_sums {
    exact_sum resultant[2], places[2], weights, moments; /* the moments about a place */
    vec2 about;
} reaction_sums;

static void add_reaction(reaction_sums *s, vec2 force, vec2 place)
{
    add(s->resultant, force);
    add(s->places, vec2_scale(vec2_norm(force), place));
    exact_sum_add(&s->weights, vec2_norm(force));
    exact_sum_add(&s->moments, vec2_cross(vec2_sub(place, s->about), force));
}

/* What acts between an obstacle and the bodies: its lasting contacts, and rigid bodies near it. */
typedef struct reaction_parts {
    const dem_contact *list;
    dem_index n, obstacle;
    const rigid_contact *rigid; /* NULL: none */
} reaction_parts;

static reaction_sums sum_reaction(const reaction_parts *p, vec2 about)
{
    reaction_sums s = {.about = about};
    for (dem_index k = 0; k < p->n; k++)
        if (p->list[k].obstacle == p->obstacle) add_reaction(&s, contact_force(&p->list[k]), vec2_at(p->list[k].x, 0));
    for (dem_index b = 0; p->rigid != NULL && b < p->rigid->n; b++) {
        const rigid_pairs *pairs = &p->rigid->list[b];
        for (dem_index q = 0; q < pairs->n_near; q++)
            if (p->rigid->obstacles.obstacle[pairs->near[q]] == p->obstacle)
                add_reaction(&s, rigid_contact_force(pairs, q),
                             vec2_at(pairs->places, rigid_pairs_place(pairs, pairs->near[q])));
    }
    return s;
}

/* The resultant F of an obstacle's contacts, and the point where it acts. With P the mean of the places, weighted by
 * the size of their forces, and M the moment about P, the line of F goes through P + (M/F^2) (F_y, -F_x): there F alone
 * has the moment of all contacts. Taking M about P rather than the origin avoids a loss of digits far from the
 * origin. */
dem_obstacle_load diagnostics_reaction(const dem_contact *list, dem_index n, dem_index obstacle,
                                       const rigid_contact *rigid)
{
    const reaction_parts parts = {list, n, obstacle, rigid};
    const reaction_sums first = sum_reaction(&parts, (vec2){0.0, 0.0});
    dem_obstacle_load load = {0};
    for (dem_index k = 0; k < n; k++) load.n_contacts += list[k].obstacle == obstacle;
    const ranks *r = &ranks_alone; /* all contacts are on every rank */
    const double weight = exact_sum_value(&first.weights);
    const vec2 sum = sum_of(r, first.resultant), places = sum_of(r, first.places);
    const vec2 mean = weight > 0.0 ? vec2_scale(1.0 / weight, places) : places;
    const reaction_sums about_mean = sum_reaction(&parts, mean);
    /* Without a resultant there is no line of action, and the mean place is given. */
    const double square = vec2_dot(sum, sum), moment = exact_sum_value(&about_mean.moments);
    const vec2 arm = square > 0.0 ? vec2_scale(moment / square, (vec2){sum.y, -sum.x}) : (vec2){0.0, 0.0};
    vec2_put(load.reaction, 0, sum);
    vec2_put(load.point, 0, vec2_add(mean, arm));
    return load;
}

/* The reaction R = m (a - a_free) of the components that the condition prescribes, N. */
static vec2 held_force(const forces *f, const boundary_condition *b, dem_index i, vec2 free, double t)
{
    const vec2 wanted = boundary_conditions_acceleration(f->boundaries, b, t);
    const vec2 force = vec2_scale(f->model->lattice.mass[i], vec2_sub(wanted, free));
    return (vec2){b->components & DEM_COMPONENT_X ? force.x : 0.0, b->components & DEM_COMPONENT_Y ? force.y : 0.0};
}

/* Acceleration of a node if its motion were not prescribed; the external force is part of it. */
static vec2 free_acceleration(const forces *f, dem_index i, const double *external, const double *x, const double *v)
{
    const vec2 own = forces_own_acceleration(f, i, x, v);
    return external != NULL ? forces_with(f, i, own, vec2_at(external, i)) : own;
}

/* The sum of the forces of the condition on its nodes, and the mean of their displacements from the places where the
 * run began, m. v[f->clock] is the time of the state. */
dem_boundary_load diagnostics_boundary(const forces *f, const boundary_condition *b, const double *external,
                                       const double *x, const double *v)
{
    const ranks *r = f->model->ranks;
    dem_boundary_load out = {0}; /* no third components */
    exact_sum resultant[2] = {0}, ways[2] = {0};
    for (dem_index k = 0; k < b->n_nodes; k++) {
        const dem_index i = b->nodes[k];
        add(ways, vec2_sub(vec2_at(x, i), vec2_at(f->model->lattice.position, i)));
        add(resultant, b->kind == DEM_BOUNDARY_FORCE
                           ? vec2_scale(b->share[k], boundary_conditions_push(f->boundaries, b, v[f->clock]))
                           : held_force(f, b, i, free_acceleration(f, i, external, x, v), v[f->clock]));
    }
    const exact_sum *const sums[] = {&resultant[0], &resultant[1], &ways[0], &ways[1]};
    double values[4];
    reduce_sums(r, sums, 4, values);
    vec2_put(out.force, 0, (vec2){values[0], values[1]});
    vec2_put(out.displacement, 0, vec2_scale(1.0 / (double)reduce_count(r, b->n_nodes), (vec2){values[2], values[3]}));
    return out;
}

/* The largest force of a spring, N: the scale of the residual. */
static double largest_force(const forces *f, const double *x)
{
    const dem_lattice *l = &f->model->lattice;
    const springs_integrity integrity = element_state_springs(f->elements);
    double largest = 0.0;
    for (dem_index k = 0; k < l->n_springs; k++) {
        if (springs_is_broken(integrity, k)) continue;
        const double strain = springs_strain_of(l, k, x), left = springs_left(integrity, k, strain);
        largest = fmax(largest, left * l->stiffness[k] * fabs(strain));
    }
    return largest;
}

/* The drag -alpha m v is taken out of m a: what is left is how far a node is off its static equilibrium, over the
 * largest force of a spring. Infinite if nodes are pushed and no spring is strained. */
double diagnostics_residual(const forces *f, const double *x, const double *v, const double *a)
{
    const dem_model *model = f->model;
    double largest = 0.0;
    for (dem_index i = 0; i < model->lattice.n_nodes; i++) {
        const vec2 without_drag = vec2_along(vec2_at(a, i), f->mass_damping, vec2_at(v, i));
        if (model->inverse_mass[i] > 0.0 && domain_owns(model->domain, i))
            largest = fmax(largest, model->lattice.mass[i] * vec2_norm(without_drag));
    }
    largest = reduce_max(model->ranks, largest);
    const double scale = reduce_max(model->ranks, largest_force(f, x));
    return largest > 0.0 ? largest / scale : 0.0;
}

/* Of the nodes `first` to `end` - 1. Eight at a time, which do not wait for each other: then compilers use vectors. */
static double fastest_of(const double *v, dem_index first, dem_index end)
{
    enum { SIDE_BY_SIDE = 8 };
    double most[SIDE_BY_SIDE] = {0.0}, largest = 0.0;
    dem_index i = first;
    for (; i + SIDE_BY_SIDE <= end; i += SIDE_BY_SIDE)
        for (int k = 0; k < SIDE_BY_SIDE; k++) {
            const double speed = fabs(v[2 * (i + k)]) + fabs(v[2 * (i + k) + 1]);
            most[k] = speed > most[k] ? speed : most[k];
        }
    for (int k = 0; k < SIDE_BY_SIDE; k++) largest = most[k] > largest ? most[k] : largest;
    for (; i < end; i++) largest = fmax(largest, fabs(v[2 * i]) + fabs(v[2 * i + 1]));
    return largest;
}

double diagnostics_fastest(const dem_model *model, const double *v)
{
    const dem_index n = model->lattice.n_nodes;
    double largest = 0.0;
    for (dem_index i = 0, end; i < n; i = end)
        if (domain_run(model->domain, i, n, &end)) largest = fmax(largest, fastest_of(v, i, end));
    return reduce_max(model->ranks, largest);
}
