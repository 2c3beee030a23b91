/* SPDX-License-Identifier: BSD-3-Clause */
/* What is measured on a state: energies, motion of bodies, extreme strains, reactions of obstacles and boundary
 * conditions, residual. Sums are exact, and equal extremes are distinguished by the nodes of a spring, so that the
 * numbers do not depend on the numbering of nodes and springs (docs/architecture.md, Numbers of the whole). Nothing
 * here feeds back into the motion. What damping and friction take is not measured but integrated with the motion
 * (simulation/right_hand_side.c); impacts have their ledger in contact/ledger.c. */
#include "forces/diagnostics.h"

#include "base/reduce.h"

/* Adds a vector to a pair of sums. */
static void add(exact_sum sum[2], vec2 term)
{
    exact_sum_add(&sum[0], term.x);
    exact_sum_add(&sum[1], term.y);
}

static vec2 sum_of(const exact_sum sum[2])
{
    return (vec2){reduce_sum(&sum[0]), reduce_sum(&sum[1])};
}

/* m v^2/2 of the n nodes from `first` on, J. */
static void fill_kinetic(const dem_lattice *l, const double *v, dem_index first, int n, double *out)
{
    for (dem_index i = first; i < first + n; i++)
        out[i - first] = 0.5 * l->mass[i] * vec2_dot(vec2_at(v, i), vec2_at(v, i));
}

/* -m g.x of the same nodes: energy of their weights, J, 0 at the origin. */
static void fill_weight(const forces *f, const double *x, dem_index first, int n, double *out)
{
    const vec2 g = {f->gravity[0], f->gravity[1]};
    for (dem_index i = first; i < first + n; i++)
        out[i - first] = -f->model->lattice.mass[i] * vec2_dot(g, vec2_at(x, i));
}

/* In springs of friction of bodies with each other and of rigid bodies with obstacles, J. */
static double stored_by_friction(const forces *f, const double *x, double t)
{
    const double between = forces_have_friction(f) ? surface_contact_stored(f->surfaces, x) : 0.0;
    return rigid_contact_has_friction(f->rigid) ? between + rigid_contact_stored(f->rigid, t, x) : between;
}

/* Terms are computed in blocks, which exact sums take faster than single terms. */
dem_energy diagnostics_energy(const forces *f, const double *x, const double *v)
{
    const dem_model *model = f->model;
    const triangles_integrity integrity = element_state_triangles(f->elements);
    dem_energy energy = {.elastic = springs_energy(&model->lattice, element_state_springs(f->elements), x)};
    energy.elastic += couplings_energy(&model->couplings, integrity, x);
    triangles_energy(&model->triangles, integrity, x, &energy.area, &energy.guard);
    exact_sum kinetic = {0}, weight = {0};
    double terms[EXACT_SUM_BLOCK];
    for (dem_index first = 0; first < model->lattice.n_nodes; first += EXACT_SUM_BLOCK) {
        const int n = exact_sum_block(first, model->lattice.n_nodes);
        fill_kinetic(&model->lattice, v, first, n, terms);
        exact_sum_take(&kinetic, terms, n);
        fill_weight(f, x, first, n, terms);
        exact_sum_take(&weight, terms, n);
    }
    energy.kinetic = reduce_sum(&kinetic);
    energy.gravity = reduce_sum(&weight);
    energy.contact = f->surfaces != NULL ? surface_contact_energy(f->surfaces, x) : 0.0;
    if (f->rigid != NULL) energy.contact += rigid_contact_energy(f->rigid, v[f->clock], x);
    const double stored = stored_by_friction(f, x, v[f->clock]);
    energy.contact += stored;
    energy.friction = 0.0 - stored; /* of all that friction has taken this can be given back */
    energy.motion = energy.kinetic + energy.elastic + energy.area + energy.guard + energy.contact;
    return energy;
}

enum { n_moments = 5 }; /* mass, mass times place, momentum */

static void take_moments(exact_sum sum[n_moments], double terms[n_moments][EXACT_SUM_BLOCK], int n)
{
    for (int k = 0; k < n_moments; k++) exact_sum_take(&sum[k], terms[k], n);
}

/* Adds m, m x and m v of the nodes of a body. */
static void add_moments(const dem_model *model, dem_index body, const double *x, const double *v,
                        exact_sum sum[n_moments])
{
    const dem_lattice *l = &model->lattice;
    const dem_index *span = &model->body_span[2 * body];
    double terms[n_moments][EXACT_SUM_BLOCK];
    int n = 0;
    for (dem_index i = span[0]; i <= span[1]; i++) {
        if (l->body[i] != body) continue;
        const double m = l->mass[i];
        const vec2 place = vec2_scale(m, vec2_at(x, i)), momentum = vec2_scale(m, vec2_at(v, i));
        terms[0][n] = m;
        terms[1][n] = place.x;
        terms[2][n] = place.y;
        terms[3][n] = momentum.x;
        terms[4][n++] = momentum.y;
        if (n < EXACT_SUM_BLOCK) continue;
        take_moments(sum, terms, n);
        n = 0;
    }
    take_moments(sum, terms, n);
}

/* Angular momentum of a body about its centre of mass, sum of m (x - x_c) x (v - v_c), kg m^2/s. mean[0] is x_c,
 * mean[1] is v_c. */
static double spin_of(const dem_model *model, dem_index body, const double *x, const double *v, const vec2 mean[2])
{
    const dem_lattice *l = &model->lattice;
    const dem_index *span = &model->body_span[2 * body];
    exact_sum sum = {0};
    double terms[EXACT_SUM_BLOCK];
    int n = 0;
    for (dem_index i = span[0]; i <= span[1]; i++) {
        if (l->body[i] != body) continue;
        const vec2 r = vec2_sub(vec2_at(x, i), mean[0]), u = vec2_sub(vec2_at(v, i), mean[1]);
        terms[n++] = l->mass[i] * vec2_cross(r, u);
        if (n < EXACT_SUM_BLOCK) continue;
        exact_sum_take(&sum, terms, n);
        n = 0;
    }
    exact_sum_take(&sum, terms, n);
    return reduce_sum(&sum);
}

/* Centre of mass and its velocity come first, since the angular momentum is taken about them. */
dem_body_motion diagnostics_body(const dem_model *model, dem_index body, const double *x, const double *v)
{
    exact_sum sum[n_moments] = {0};
    /* All sums of the body at once, in one pass over the nodes. */
    add_moments(model, body, x, v, sum);
    const double mass = reduce_sum(&sum[0]);
    const vec2 centre = vec2_scale(1.0 / mass, sum_of(&sum[1])), velocity = vec2_scale(1.0 / mass, sum_of(&sum[3]));
    const double spin = spin_of(model, body, x, v, (const vec2[]){centre, velocity});
    return (dem_body_motion){.mass = mass,
                             .centre = {centre.x, centre.y},
                             .velocity = {velocity.x, velocity.y},
                             .angular_momentum = {0.0, 0.0, spin}};
}

/* The smallest ratio of area to rest area, the number of triangles on which the guard acts, and that of inverted ones.
 * Broken triangles are left out. */
static void measure_triangles(const forces *f, const double *x, dem_strain *strain)
{
    const dem_lattice *l = &f->model->lattice;
    for (dem_index k = 0; k < l->n_triangles; k++) {
        if (f->elements != NULL && f->elements->triangle[k]) continue;
        const dem_index *c = &l->triangles[3 * k];
        /* From the lattice's rest positions, as triangles_compile() has it: the ratio is exactly 1 at rest. */
        const double rest_area = vec2_triangle_area(vec2_at(l->x, c[0]), vec2_at(l->x, c[1]), vec2_at(l->x, c[2]));
        const double ratio = vec2_triangle_area(vec2_at(x, c[0]), vec2_at(x, c[1]), vec2_at(x, c[2])) / rest_area;
        if (ratio < strain->area_min) strain->area_min = ratio;
        strain->guarded += ratio < TRIANGLES_GUARD_ONSET && l->guard != NULL && l->guard[k] > 0.0;
        strain->inverted += ratio <= 0.0;
    }
    strain->area_min = reduce_min(strain->area_min);
    strain->guarded = reduce_count(strain->guarded);
    strain->inverted = reduce_count(strain->inverted);
}

/* The ends of a spring, the lower number first. */
typedef struct spring_ends {
    dem_index low, high;
} spring_ends;

static spring_ends ends_of(const dem_lattice *l, dem_index spring)
{
    const dem_index *ends = &l->ends[2 * spring];
    return ends[0] < ends[1] ? (spring_ends){ends[0], ends[1]} : (spring_ends){ends[1], ends[0]};
}

/* Of springs with equal strains the first one by its ends is named: this does not depend on the order of springs. */
static bool is_before(const dem_lattice *l, dem_index spring, dem_index other)
{
    const spring_ends a = ends_of(l, spring), b = ends_of(l, other);
    return a.low != b.low ? a.low < b.low : a.high < b.high;
}

/* The extremes so far, and their springs; -1: none. */
typedef struct extreme_strains {
    double min, max;
    dem_index least, largest;
} extreme_strains;

/* Keeps spring k if its strain is beyond the extremes so far, or equal to one of them and first by its ends. */
static void measure_spring(const dem_lattice *l, dem_index k, double strain, extreme_strains *e)
{
    if (e->least < 0 || strain < e->min || (strain == e->min && is_before(l, k, e->least))) {
        e->min = strain;
        e->least = k;
    }
    if (e->largest < 0 || strain > e->max || (strain == e->max && is_before(l, k, e->largest))) {
        e->max = strain;
        e->largest = k;
    }
}

/* Extremes over springs that are not broken; strains come in blocks with vector instructions. */
static void measure_springs(const forces *f, const double *x, dem_strain *strain)
{
    const dem_lattice *l = &f->model->lattice;
    const springs_integrity integrity = element_state_springs(f->elements);
    extreme_strains e = {.least = -1, .largest = -1};
    double block[EXACT_SUM_BLOCK];
    for (dem_index first = 0; first < l->n_springs; first += EXACT_SUM_BLOCK) {
        const int n = exact_sum_block(first, l->n_springs);
        springs_strain_block(l, first, n, x, block);
        for (int q = 0; q < n; q++)
            if (!springs_is_broken(integrity, first + q)) measure_spring(l, first + q, block[q], &e);
    }
    /* The key tells which of equal values counts if several processes have one. */
    reduce_least(&e.min, &e.least, e.least < 0 ? -1 : ends_of(l, e.least).low);
    reduce_largest(&e.max, &e.largest, e.largest < 0 ? -1 : ends_of(l, e.largest).low);
    strain->min = e.min;
    strain->max = e.max;
    strain->spring_min = e.least;
    strain->spring_max = e.largest;
}

dem_strain diagnostics_strain(const forces *f, const double *x)
{
    dem_strain strain = {.area_min = 1.0};
    measure_springs(f, x, &strain);
    measure_triangles(f, x, &strain);
    return strain;
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
    load.n_contacts = reduce_count(load.n_contacts);
    const double weight = reduce_sum(&first.weights);
    const vec2 sum = sum_of(first.resultant), places = sum_of(first.places);
    const vec2 mean = weight > 0.0 ? vec2_scale(1.0 / weight, places) : places;
    const reaction_sums about_mean = sum_reaction(&parts, mean);
    /* Without a resultant there is no line of action, and the mean place is given. */
    const double square = vec2_dot(sum, sum), moment = reduce_sum(&about_mean.moments);
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
    dem_boundary_load out = {0}; /* no third components */
    exact_sum resultant[2] = {0}, ways[2] = {0};
    for (dem_index k = 0; k < b->n_nodes; k++) {
        const dem_index i = b->nodes[k];
        add(ways, vec2_sub(vec2_at(x, i), vec2_at(f->model->lattice.position, i)));
        add(resultant, b->kind == DEM_BOUNDARY_FORCE
                           ? vec2_scale(b->share[k], boundary_conditions_push(f->boundaries, b, v[f->clock]))
                           : held_force(f, b, i, free_acceleration(f, i, external, x, v), v[f->clock]));
    }
    vec2_put(out.force, 0, sum_of(resultant));
    vec2_put(out.displacement, 0, vec2_scale(1.0 / (double)reduce_count(b->n_nodes), sum_of(ways)));
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
        if (model->inverse_mass[i] > 0.0) largest = fmax(largest, model->lattice.mass[i] * vec2_norm(without_drag));
    }
    largest = reduce_max(largest);
    const double scale = reduce_max(largest_force(f, x));
    return largest > 0.0 ? largest / scale : 0.0;
}
