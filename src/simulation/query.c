/* SPDX-License-Identifier: BSD-3-Clause */
/* What observers and callers see of a run: the state at some time, and all that dem.h can be asked about it. A state
 * within the step in hand is interpolated, and results are computed, only when they are asked for, each once
 * (run_measures). To show contacts and ledger of an earlier time the event queue goes back, and on again when the run
 * goes on, to the same bits. Ranks that share a model exchange ghosts for what depends on more than a node of their
 * own, and all ask for the same (dem/mpi.h). What would call a function of the caller is not left until then:
 * query_ask() does it during the advance, which reports a failure. */
#include "simulation/query.h"

#include <string.h>

#include "base/reduce.h"
#include "base/sorted.h"
#include "base/status.h"
#include "base/struct_size.h"
#include "contact/obstacle_load.h"
#include "domain/gather.h"
#include "forces/diagnostics.h"
#include "lattice/lattice_source.h"
#include "model/crack_energy.h"
#include "model/fragments.h"
#include "model/node_stress.h"
#include "simulation/body_contact.h"
#include "simulation/led_ranks.h"
#include "simulation/led_run.h"
#include "simulation/shared_breaks.h"
#include "simulation/shared_field.h"

void query_at(dem_simulation *s, double t, const double *y)
{
    s->seen_t = t;
    s->seen = y;
    *s->measures = (run_measures){.has_events = true, .has_state = y != s->frame};
}

void query_inside(dem_simulation *s, double t)
{
    query_at(s, t, s->frame);
    s->measures->has_events = !run_is_local(s);
}

/* The contacts and ledger at the time seen: the queue takes back later events, and resolves them again when the run
 * goes on, with the same result. With functions of the caller query_ask() has done so already. */
static dem_status show_events(dem_simulation *s)
{
    if (s->measures->has_events) return DEM_OK;
    s->measures->has_events = true;
    return event_queue_show(&s->queue, s->seen_t);
}

static const automaton *contact_of(const dem_simulation *s)
{
    (void)show_events((dem_simulation *)s); /* cannot fail: these events were resolved before */
    return &s->automaton;
}

static const double *seen_of(const dem_simulation *s)
{
    (void)contact_of(s);
    if (s->measures->has_state) return s->seen;
    s->measures->has_state = true;
    if (s->leads != NULL) {
        led_run_gather((dem_simulation *)s);
        return s->seen;
    }
    dense_output_state(&s->path, s->seen_t, s->frame);
    rigid_motion_put_back(&s->model->rigid, run_keeps(s), s->frame, s->frame + state_velocities(&s->layout));
    return s->seen;
}

/* The state as seen, with what other ranks have of it. No motion depends on ghosts as they are left here. */
static const double *all_seen_of(const dem_simulation *s)
{
    const double *y = seen_of(s);
    if (s->model->domain == NULL || s->measures->has_ghosts) return y;
    s->shared.fill_ghosts(y == s->y ? s->y : s->frame, (dem_simulation *)s);
    s->measures->has_ghosts = true;
    return y;
}

/* Who asks for one of these numbers mostly asks for the others, too: all are measured in one pass. */
static const survey *survey_of(const dem_simulation *s)
{
    const double *y = all_seen_of(s);
    if (!s->measures->has_survey) survey_take(s->survey, &s->forces, y, y + state_velocities(&s->layout));
    s->measures->has_survey = true;
    return s->survey;
}

static void measure_energy(const dem_simulation *s)
{
    run_measures *m = s->measures;
    const double *y = seen_of(s);
    if (!m->has_energy) m->energy = diagnostics_energy(&s->forces, survey_of(s), y, y + state_velocities(&s->layout));
    m->has_energy = true;
}

static void list_contacts(const dem_simulation *s)
{
    run_measures *m = s->measures;
    m->contacts = automaton_list(&s->automaton, s->seen_t, seen_of(s), &m->n_contacts);
    m->has_contacts = true;
}

/* What obstacles do to rigid bodies. */
static dem_status measure_rigid(const dem_simulation *s)
{
    const double *y = seen_of(s);
    if (s->rigid == NULL || s->measures->has_rigid) return DEM_OK;
    s->measures->has_rigid = rigid_contact_evaluate(s->rigid, y[state_velocities(&s->layout) + s->forces.clock], y);
    return s->measures->has_rigid ? DEM_OK : s->rigid->status;
}

/* Contacts depend on where obstacles are. */
void query_ask_poses(dem_simulation *s)
{
    const obstacle_set *o = &s->model->obstacles;
    if (s->poses == NULL) return;
    for (dem_index k = 0; k < o->n; k++) s->poses[k] = motion_law_pose(&o->laws[k], s->seen_t);
    list_contacts(s);
    (void)measure_rigid(s); /* what fails is evaluated again, and refused, when it is asked for */
    if (s->rigid != NULL) measure_energy(s);
    s->measures->has_poses = true;
}

dem_status query_ask(dem_simulation *s)
{
    if (s->external == NULL && s->poses == NULL) return DEM_OK;
    TRY(show_events(s));
    if (s->external != NULL) held_forces_ask(&s->held_forces, s->external, &s->layout, seen_of(s));
    s->measures->has_held_forces = true;
    query_ask_poses(s);
    return run_force_failed(s) ? DEM_STOPPED : DEM_OK;
}

/* Whether it is known where obstacles are: functions of the caller that have not been asked are not asked now. Laws
 * keep the pose at t = 0. */
static bool poses_are_known(const dem_simulation *s)
{
    return s->poses == NULL || s->measures->has_poses || s->seen_t == 0.0;
}

/* Without the poses none are listed. */
static const dem_contact *contacts_of(const dem_simulation *s, dem_index *n)
{
    const run_measures *m = s->measures;
    *n = 0;
    if (s->leads != NULL) return led_ranks_check(s->leads) == DEM_OK ? contacts_of(led_run_part(s->leads), n) : NULL;
    if (!m->has_contacts && poses_are_known(s)) list_contacts(s);
    *n = m->n_contacts;
    return m->contacts;
}

/* ---- what a getter is asked with ---- */

static dem_status check_pointers(const char *function, const dem_simulation *s, const void *out)
{
    CHECK(s != NULL && out != NULL, DEM_ERROR_ARGUMENT, "%s: %s is NULL", function,
          s == NULL ? "simulation" : "where to write");
    return DEM_OK;
}

/* What ranks have of a run that is led is asked of them. */
static dem_status check_asked(const char *function, const dem_simulation *s, const void *out)
{
    TRY(check_pointers(function, s, out));
    return s->leads != NULL ? led_ranks_check(s->leads) : DEM_OK;
}

/* What is found by a search of all bodies. */
static dem_status check_whole(const char *function, const dem_simulation *s, const void *out)
{
    TRY(check_asked(function, s, out));
    CHECK(s->model->domain == NULL, DEM_ERROR_ARGUMENT, "%s: not known yet of a model that ranks share", function);
    return DEM_OK;
}

#define GIVE(type, theirs, ours) struct_size_write(&STRUCT_KIND(type), theirs, ours)

/* ---- public ---- */

dem_status dem_simulation_state(const dem_simulation *s, dem_state *out)
{
    TRY(check_asked("dem_simulation_state", s, out));
    dem_index n_contacts;
    (void)contacts_of(s, &n_contacts);
    const dem_state seen = {.t = s->seen_t,
                            .step = s->step,
                            .x = seen_of(s),
                            .v = s->seen + state_velocities(&s->layout),
                            .n_contacts = n_contacts};
    return GIVE(dem_state, out, &seen);
}

dem_status dem_simulation_progress(const dem_simulation *s, dem_progress *out)
{
    TRY(check_pointers("dem_simulation_progress", s, out));
    dem_progress seen = {.t = s->seen_t, .step = s->step};
    (void)contacts_of(s, &seen.n_contacts);
    return GIVE(dem_progress, out, &seen);
}

static dem_status check_gathered(const dem_simulation *s, const double *x, const double *v)
{
    CHECK(s->model->ranks->rank != 0 || (x != NULL && v != NULL), DEM_ERROR_ARGUMENT,
          "dem_simulation_gather: %s is NULL", x == NULL ? "x" : "v");
    return DEM_OK;
}

dem_status dem_simulation_gather(const dem_simulation *s, double *x, double *v)
{
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_gather: simulation is NULL");
    const dem_model *m = s->model;
    TRY(reduce_status(m->ranks, check_gathered(s, x, v), 0.0));
    const double *seen = seen_of(s), *velocities = s->seen + state_velocities(&s->layout);
    const size_t size = (size_t)state_row(&s->layout, m->lattice.n_nodes) * sizeof *x;
    if (m->domain != NULL) {
        const gather_items nodes = gather_nodes(m->domain);
        const size_t row = (size_t)s->layout.dim * sizeof *x;
        TRY(gather_rows(m->ranks, &nodes, row, seen, x));
        return gather_rows(m->ranks, &nodes, row, velocities, v);
    }
    memcpy(x, seen, size);
    memcpy(v, velocities, size);
    return DEM_OK;
}

/* Mechanical energies are computed once; the others are sums that are there. */
static dem_energy energy_of(const dem_simulation *s)
{
    const run_measures *m = s->measures;
    const double *y = seen_of(s);
    const contact_ledger *ledger = &contact_of(s)->set.ledger;
    const state_layout *l = &s->layout;
    measure_energy(s);
    dem_energy e = m->energy;
    e.impact = exact_sum_value(&ledger->impact);
    e.fracture = exact_sum_value(&s->fracture);
    e.friction += state_total_of(l, y, STATE_FRICTION);
    e.damping = state_total_of(l, y, STATE_DAMPING);
    e.projection = exact_sum_value(&ledger->projection);
    e.boundary = state_total_of(l, y, STATE_WORK);
    e.obstacle = exact_sum_value(&ledger->work);
    if (state_has_total(l, STATE_OBSTACLE)) e.obstacle += state_total_of(l, y, STATE_OBSTACLE);
    e.ledger =
        e.motion + e.gravity + e.impact + e.friction + e.damping + e.fracture - e.projection - e.boundary - e.obstacle;
    return e;
}

dem_status dem_simulation_energy(const dem_simulation *s, dem_energy *out)
{
    TRY(check_asked("dem_simulation_energy", s, out));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_ENERGY, 0, out);
    const dem_energy seen = energy_of(s);
    return GIVE(dem_energy, out, &seen);
}

dem_status dem_simulation_strain(const dem_simulation *s, dem_strain *out)
{
    TRY(check_asked("dem_simulation_strain", s, out));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_STRAIN, 0, out);
    return GIVE(dem_strain, out, &survey_of(s)->strain);
}

dem_status dem_simulation_contact(const dem_simulation *s, dem_index contact, dem_contact *out)
{
    TRY(check_asked("dem_simulation_contact", s, out));
    dem_index n;
    const dem_contact *contacts = contacts_of(s, &n);
    TRY(status_check_number("contact", contact, n));
    return GIVE(dem_contact, out, &contacts[contact]);
}

/* Of a simulation that leads a run.  \param out  NULL: not wanted */
static dem_status ask_field(const dem_simulation *s, field_kind field, void *out)
{
    return out != NULL ? led_run_ask(s, RANK_CALL_FIELD, (dem_index)field, out) : DEM_OK;
}

/* What is broken at the time that is seen, as breaks are taken back with the other events: of a simulation that leads
 * a run what the part of this rank has, in which all is that may break. NULL: all elements are whole. */
static dem_status find_elements(const dem_simulation *s, const element_state **out)
{
    const dem_simulation *part = s->leads != NULL ? led_run_part(s->leads) : s;
    (void)contact_of(part);
    if (s->leads != NULL && !s->measures->has_elements) {
        TRY(shared_breaks_show((dem_simulation *)s, part));
        s->measures->has_elements = true;
    }
    *out = s->forces.elements;
    return DEM_OK;
}

dem_status dem_simulation_strains(const dem_simulation *s, double *strain)
{
    const element_state *elements;
    TRY(check_asked("dem_simulation_strains", s, strain));
    if (s->leads != NULL) return ask_field(s, FIELD_STRAINS, strain);
    TRY(find_elements(s, &elements));
    const double *x = all_seen_of(s);
    if (s->measures->has_stress)
        stress_field_strains(s->field, elements, strain);
    else
        springs_strains(&s->model->lattice, element_state_springs(elements), x, strain);
    return DEM_OK;
}

dem_status dem_simulation_forces(const dem_simulation *s, double *force)
{
    const element_state *elements;
    TRY(check_asked("dem_simulation_forces", s, force));
    if (s->leads != NULL) return ask_field(s, FIELD_FORCES, force);
    TRY(find_elements(s, &elements));
    const double *x = all_seen_of(s);
    springs_forces(&s->model->lattice, element_state_springs(elements), x, force);
    couplings_add_tensions(&s->model->couplings, element_state_triangles(elements), x, force);
    return DEM_OK;
}

static double force_of(const dem_simulation *s, dem_index spring, const double *x)
{
    const dem_lattice *l = &s->model->lattice;
    const springs_integrity integrity = element_state_springs(s->forces.elements);
    const double strain = springs_is_broken(integrity, spring) ? 0.0 : springs_strain_of(l, spring, x);
    const double own = strain * (springs_left(integrity, spring, strain) * l->stiffness[spring]);
    return couplings_add_tension(&s->model->couplings, element_state_triangles(s->forces.elements), l->ends[2 * spring],
                                 spring, x, own);
}

dem_status dem_simulation_force_at(const dem_simulation *s, dem_index spring, double *out)
{
    TRY(check_asked("dem_simulation_force_at", s, out));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_FORCE_AT, spring, out);
    const dem_lattice *l = &s->model->lattice;
    const domain *d = s->model->domain;
    TRY(status_check_number("spring", spring, d != NULL ? d->n_springs : l->n_springs));
    const double *x = all_seen_of(s);
    const dem_index k = d != NULL ? sorted_find(d->spring, l->n_springs, spring) : spring;
    const bool is_here = k >= 0 && domain_owns(d, domain_lowest(&l->ends[2 * k], 2));
    double force = is_here ? force_of(s, k, x) : 0.0;
    reduce_report(s->model->ranks, is_here, &force, 1);
    *out = force;
    return DEM_OK;
}

dem_status dem_simulation_broken(const dem_simulation *s, unsigned char *triangle, unsigned char *spring)
{
    const element_state *elements;
    TRY(check_asked("dem_simulation_broken", s, s));
    TRY(find_elements(s, &elements));
    const dem_lattice *l = &s->model->lattice;
    for (dem_index k = 0; k < l->n_triangles && triangle != NULL; k++)
        triangle[k] = elements != NULL && elements->triangle[k];
    for (dem_index k = 0; k < l->n_springs && spring != NULL; k++)
        spring[k] = springs_is_broken(element_state_springs(elements), k);
    return DEM_OK;
}

dem_status dem_simulation_damage(const dem_simulation *s, double *triangle, double *node)
{
    const element_state *elements;
    TRY(check_asked("dem_simulation_damage", s, s));
    TRY(find_elements(s, &elements));
    const dem_lattice *l = &s->model->lattice;
    for (dem_index t = 0; t < l->n_triangles && triangle != NULL; t++) triangle[t] = element_state_damage(elements, t);
    for (dem_index i = 0; i < l->n_nodes && node != NULL; i++) node[i] = element_state_node_damage(elements, i);
    return DEM_OK;
}

dem_status dem_simulation_fragments(const dem_simulation *s, dem_index *n_fragments, dem_index *fragment)
{
    const element_state *elements;
    TRY(check_whole("dem_simulation_fragments", s, n_fragments));
    TRY(check_whole("dem_simulation_fragments", s, fragment));
    TRY(find_elements(s, &elements));
    *n_fragments = fragments_find(&s->model->lattice, element_state_springs(elements).pushed, fragment);
    return DEM_OK;
}

static dem_status measure_fragments(const dem_simulation *s, const element_state *elements, dem_fracture *out)
{
    const lattice_source from = dem_private_lattice_source(s->model);
    if (from.whole == NULL) return fragments_measure(&s->model->lattice, elements, out);
    return fragments_measure_source(&from, out);
}

dem_status dem_simulation_fracture(const dem_simulation *s, dem_fracture *out)
{
    const element_state *elements;
    dem_fracture seen;
    TRY(check_whole("dem_simulation_fracture", s, out));
    TRY(find_elements(s, &elements));
    const dem_simulation *part = s->leads != NULL ? led_run_part(s->leads) : s;
    const contact_burials *buried = &part->automaton.set.burials;
    TRY(measure_fragments(s, elements, &seen));
    seen.buried = buried->n;
    seen.buried_node = buried->n > 0 ? model_node(part->model, buried->node) : -1;
    seen.buried_t = buried->t;
    state_copy_row(&s->layout, seen.buried_x, buried->x);
    return GIVE(dem_fracture, out, &seen);
}

dem_status dem_simulation_crack_energy(const dem_simulation *s, double *energy)
{
    const element_state *elements;
    TRY(check_whole("dem_simulation_crack_energy", s, energy));
    TRY(find_elements(s, &elements));
    return crack_energy(&s->model->lattice, elements, energy);
}

/* What one rank has no memory for none goes on with. */
static dem_status prepare_stress(const dem_simulation *s)
{
    return reduce_status(s->model->ranks, stress_prepare(&s->model->stress), 0.0);
}

dem_status dem_simulation_stress(const dem_simulation *s, double *stress)
{
    const element_state *elements;
    TRY(check_asked("dem_simulation_stress", s, stress));
    if (s->leads != NULL) return ask_field(s, FIELD_STRESS, stress);
    TRY(find_elements(s, &elements));
    TRY(prepare_stress(s));
    const double *x = all_seen_of(s);
    const double area_min = s->measures->has_survey ? s->survey->strain.area_min : 0.0;
    s->measures->has_stress = stress_field_take(s->field, elements, x, area_min, stress);
    return DEM_OK;
}

dem_status dem_simulation_stress_at(const dem_simulation *s, dem_index node, double *stress)
{
    TRY(check_asked("dem_simulation_stress_at", s, stress));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_STRESS_AT, node, stress);
    const domain *d = s->model->domain;
    double own[3] = {0};
    TRY(status_check_number("node", node, d != NULL ? d->n_whole : s->model->lattice.n_nodes));
    TRY(prepare_stress(s));
    const double *x = all_seen_of(s);
    const dem_index i = domain_node(d, node);
    const bool is_here = i >= 0 && domain_owns(d, i);
    if (is_here) node_stress(s->model, s->forces.elements, NODE_STRESS_CARRIED, i, x, own);
    reduce_report(s->model->ranks, is_here, own, 3);
    memcpy(stress, own, sizeof own);
    return DEM_OK;
}

dem_status dem_simulation_overlap(const dem_simulation *s, dem_overlap *out)
{
    TRY(check_asked("dem_simulation_overlap", s, out));
    if (s->leads != NULL) return dem_simulation_overlap(led_run_part(s->leads), out);
    return GIVE(dem_overlap, out, &s->overlap.found);
}

const dem_surfaces *query_surfaces(const dem_simulation *s)
{
    run_measures *m = s->measures;
    if (!m->has_surfaces) m->surfaces = body_contact_surfaces(s, s->surfaces != NULL ? seen_of(s) : NULL);
    m->has_surfaces = true;
    return &m->surfaces;
}

dem_status dem_simulation_surfaces(const dem_simulation *s, dem_surfaces *out)
{
    TRY(check_asked("dem_simulation_surfaces", s, out));
    if (s->leads != NULL) return dem_simulation_surfaces(led_run_part(s->leads), out);
    return GIVE(dem_surfaces, out, query_surfaces(s));
}

/* They are listed when the first of them is asked for. */
dem_status dem_simulation_pair(const dem_simulation *s, dem_index pair, dem_pair *out)
{
    TRY(check_asked("dem_simulation_pair", s, out));
    if (s->leads != NULL) return dem_simulation_pair(led_run_part(s->leads), pair, out);
    const double *x = seen_of(s);
    if (!s->measures->has_pairs) TRY(body_contact_list((dem_simulation *)s, x));
    s->measures->has_pairs = true;
    TRY(status_check_number("pair", pair, s->pushing.n));
    const dem_pair seen = surface_load_pair(&s->pushing, pair, &s->surfaces->surface, x);
    return GIVE(dem_pair, out, &seen);
}

dem_status dem_simulation_contact_forces(const dem_simulation *s, double *force)
{
    TRY(check_asked("dem_simulation_contact_forces", s, force));
    if (s->leads != NULL) return led_run_spread(s, dem_simulation_contact_forces, s->layout.dim, force);
    memset(force, 0, (size_t)(s->layout.dim * s->model->lattice.n_nodes) * sizeof *force);
    if (s->surfaces != NULL) surface_load_forces(s->surfaces, seen_of(s), force);
    return DEM_OK;
}

dem_status dem_simulation_contact_pressures(const dem_simulation *s, double *pressure)
{
    TRY(check_asked("dem_simulation_contact_pressures", s, pressure));
    if (s->leads != NULL) return led_run_spread(s, dem_simulation_contact_pressures, 1, pressure);
    memset(pressure, 0, (size_t)s->model->lattice.n_nodes * sizeof *pressure);
    return s->surfaces != NULL ? surface_load_pressures(s->surfaces, seen_of(s), pressure) : DEM_OK;
}

dem_status dem_simulation_counts(const dem_simulation *s, dem_counts *out)
{
    TRY(check_asked("dem_simulation_counts", s, out));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_COUNTS, 0, out);
    const dem_counts of_integrator = integrator_counts(&s->integrator);
    dem_counts counts = contact_of(s)->set.ledger.counts;
    counts.steps = of_integrator.steps;
    counts.rejected = of_integrator.rejected;
    counts.evaluations = of_integrator.evaluations;
    counts.retries = of_integrator.retries;
    counts.crossings = s->crossings;
    counts.events = s->events + (s->in_hand ? s->queue.n_taken : 0);
    return GIVE(dem_counts, out, &counts);
}

/* Who asks about one body usually asks about all. */
static void measure_bodies(const dem_simulation *s)
{
    const double *y = seen_of(s);
    if (!s->measures->has_survey) survey_take_motions(s->survey, y, y + state_velocities(&s->layout));
    survey_bodies(s->survey, y, y + state_velocities(&s->layout), s->bodies);
    s->measures->has_bodies = true;
}

dem_status dem_simulation_body(const dem_simulation *s, dem_index body, dem_body_motion *out)
{
    TRY(check_asked("dem_simulation_body", s, out));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_BODY, body, out);
    TRY(status_check_number("body", body, s->model->n_bodies));
    if (!s->measures->has_bodies) measure_bodies(s);
    return GIVE(dem_body_motion, out, &s->bodies[body]);
}

dem_status dem_simulation_inertia(const dem_simulation *s, dem_index body, double *inertia)
{
    TRY(check_asked("dem_simulation_inertia", s, inertia));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_INERTIA, body, inertia);
    TRY(status_check_number("body", body, s->model->n_bodies));
    if (!s->measures->has_bodies) measure_bodies(s);
    if (!s->measures->has_inertia) survey_inertia(s->survey, seen_of(s), s->bodies, s->inertia);
    s->measures->has_inertia = true;
    *inertia = s->inertia[body];
    return DEM_OK;
}

/* An obstacle at rest keeps the zeros that the load has. */
static void add_motion(const dem_simulation *s, dem_index obstacle, dem_obstacle_load *load)
{
    const motion_law *law = &s->model->obstacles.laws[obstacle];
    dem_index n;
    const dem_contact *closed = contacts_of(s, &n);
    if (!law->moves) return;
    if (law->of->motion != NULL && !poses_are_known(s)) {
        load->displacement[0] = load->displacement[1] = load->angle = load->power = (double)NAN;
        return;
    }
    const pose at = s->measures->has_poses ? s->poses[obstacle] : motion_law_pose(law, s->seen_t);
    obstacle_load_add_motion(load, &at, obstacle, closed, n);
    if (s->rigid != NULL) load->power += rigid_contact_power(s->rigid, obstacle);
}

dem_status dem_simulation_obstacle(const dem_simulation *s, dem_index obstacle, dem_obstacle_load *out)
{
    TRY(check_asked("dem_simulation_obstacle", s, out));
    if (s->leads != NULL) return dem_simulation_obstacle(led_run_part(s->leads), obstacle, out);
    TRY(status_check_number("obstacle", obstacle, s->model->obstacles.n));
    const contact_ledger *ledger = &contact_of(s)->set.ledger;
    const state_layout *l = &s->layout;
    dem_index n_closed;
    const dem_contact *closed = contacts_of(s, &n_closed);
    const double *lasting = state_v(l, seen_of(s), state_impulse(l, obstacle));
    const double *rubbing = state_v(l, seen_of(s), state_friction_impulse(l, obstacle));
    TRY(measure_rigid(s));
    dem_obstacle_load load = diagnostics_reaction(closed, n_closed, obstacle, s->rigid);
    add_motion(s, obstacle, &load);
    for (int k = 0; k < 2; k++) {
        load.impulse[k] = exact_sum_value(&ledger->impulse[2 * obstacle + k]) + lasting[k];
        load.friction_impulse[k] = exact_sum_value(&ledger->friction_impulse[2 * obstacle + k]) + rubbing[k];
    }
    return GIVE(dem_obstacle_load, out, &load);
}

dem_status dem_simulation_boundary(const dem_simulation *s, dem_index k, dem_boundary_load *out)
{
    TRY(check_asked("dem_simulation_boundary", s, out));
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_BOUNDARY, k, out);
    TRY(status_check_number("boundary", k, s->boundaries.n));
    const boundary_condition *b = &s->boundaries.list[k];
    const double *y = all_seen_of(s), *external = s->held_forces.force; /* NULL: no node here is held */
    dem_boundary_load load = diagnostics_boundary(&s->forces, b, external, y, y + state_velocities(&s->layout));
    const bool known = b->kind == DEM_BOUNDARY_FORCE || s->external == NULL || s->measures->has_held_forces;
    if (!known) load.force[0] = load.force[1] = (double)NAN;
    return GIVE(dem_boundary_load, out, &load);
}

double dem_simulation_fastest(const dem_simulation *s)
{
    if (check_asked("dem_simulation_fastest", s, s) != DEM_OK) return (double)NAN;
    double of_parts = 0.0;
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_FASTEST, 0, &of_parts) == DEM_OK ? of_parts : (double)NAN;
    return diagnostics_fastest(s->model, seen_of(s) + state_velocities(&s->layout));
}

/* Of the end of a step.  \param y  the state there, with ghosts */
static double residual_of(const dem_simulation *s, const double *y)
{
    const dem_index v = state_velocities(&s->layout);
    return diagnostics_residual(&s->forces, y, y + v, s->path.f1 + v);
}

static bool is_residual_known(const dem_simulation *s)
{
    return s->path.f1 != NULL && !s->in_hand && !s->at_event && s->path.end == s->path.t1;
}

/* Something else may be seen, and of the end of the step, which is the integrator's, ghosts are not all known: they are
 * filled where they belong, and nothing else of it changes. */
double query_residual(const dem_simulation *s)
{
    double *y = (double *)(uintptr_t)s->path.y1;
    if (!is_residual_known(s)) return (double)INFINITY;
    if (s->model->domain != NULL) s->shared.fill_ghosts(y, (dem_simulation *)s);
    return residual_of(s, y);
}

double dem_simulation_residual(const dem_simulation *s)
{
    if (check_asked("dem_simulation_residual", s, s) != DEM_OK) return (double)NAN;
    double of_parts = 0.0;
    if (s->leads != NULL) return led_run_ask(s, RANK_CALL_RESIDUAL, 0, &of_parts) == DEM_OK ? of_parts : (double)NAN;
    if (s->seen != s->y || !is_residual_known(s)) return (double)INFINITY;
    return residual_of(s, s->model->domain != NULL ? all_seen_of(s) : s->path.y1);
}

double dem_simulation_ramp_time(const dem_simulation *s)
{
    if (check_asked("dem_simulation_ramp_time", s, s) != DEM_OK) return (double)NAN;
    const dem_simulation *part = s->leads != NULL ? led_run_part(s->leads) : s;
    return load_clock_time(&part->boundaries.clock, s->seen_t);
}

const dem_checkpoint *dem_simulation_checkpoint(const dem_simulation *s)
{
    if (check_pointers("dem_simulation_checkpoint", s, s) != DEM_OK) return NULL;
    return s->has_checkpoint && s->model->ranks->rank == 0 ? s->checkpoint : NULL;
}

const dem_model *dem_simulation_model(const dem_simulation *s)
{
    return check_pointers("dem_simulation_model", s, s) == DEM_OK ? s->model : NULL;
}

dem_status dem_simulation_options(const dem_simulation *s, dem_options *out)
{
    TRY(check_asked("dem_simulation_options", s, out));
    return GIVE(dem_options, out, &s->options);
}
