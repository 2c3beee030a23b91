/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact of bodies with each other in the time loop. A step is only taken if no node has crossed an edge in it: the
 * potential has no bound, so that a crossing is always a step that was too long. The force itself is part of the
 * right-hand side (forces/forces.h); the pairs and their potential are in src/surface_contact. Ranks that share a model
 * have all surfaces, and each finds what a process alone does without asking another one. */
#include "simulation/body_contact.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/reduce.h"
#include "base/status.h"
#include "simulation/guard_bound.h"
#include "surface_contact/contact_potential.h"
#include "surface_contact/surface_start.h"
#include "time/butcher.h"

enum { worth_noting = 4 /* evaluations: a look that notes the bound costs as much as two */ };

dem_status body_contact_create(dem_simulation *s)
{
    const dem_options *o = &s->options;
    const surface_contact_rule rule = {.within_bodies = o->bodies == DEM_BODIES_ALL,
                                       .thickness = o->contact_thickness,
                                       .stiffness = o->contact_stiffness,
                                       .friction = o->contact_friction,
                                       .body_friction = o->body_friction,
                                       .part = s->model->touching};
    CHECK(o->n_body_frictions == 0 || o->n_body_frictions == s->model->n_bodies, DEM_ERROR_ARGUMENT,
          "body_friction is of %lld bodies, but there are %lld", (long long)o->n_body_frictions,
          (long long)s->model->n_bodies);
    s->options.body_friction = NULL;
    const rigid_bodies *rigid = &s->model->rigid;
    CHECK(rigid->n == 0 || o->bodies != DEM_BODIES_NONE, DEM_ERROR_MODEL,
          "body %lld is rigid, and touches nothing without the option bodies", (long long)rigid->list[0].number);
    if (o->bodies == DEM_BODIES_NONE) return DEM_OK;
    TRY(surface_contact_create(&s->surfaces, &s->model->lattice, &rule));
    TRY(rigid_contact_create(&s->rigid, s->model, &s->surfaces->surface));
    step_reach reach;
    TRY(butcher_reach(&reach, o->method));
    const double longest = o->fixed_step > 0.0 ? o->fixed_step : o->max_step;
    approach_bound_create(&s->surfaces->bound, reach, longest, worth_noting);
    return body_contact_check_start(s, s->model->lattice.position);
}

dem_status body_contact_check_start(dem_simulation *s, const double *x)
{
    if (s->surfaces == NULL) return DEM_OK;
    if (s->rigid != NULL) TRY(rigid_contact_check_start(s->rigid, s->seen_t, x));
    TRY(surface_contact_follow(s->surfaces, x));
    return surface_start_check(s->surfaces, x);
}

dem_status body_contact_follow(dem_simulation *s, const double *y)
{
    body_contact_begin_anew(s);
    return s->surfaces != NULL ? surface_contact_follow(s->surfaces, y) : DEM_OK;
}

/* ---- evaluations ---- */

/* Motions of rigid bodies and prescribed ones do not follow from the accelerations that are taken. */
static bool is_free(const dem_simulation *s)
{
    return s->rigid == NULL && s->boundaries.n == 0;
}

void body_contact_begin_step(dem_simulation *s)
{
    const double *y = integrator_state(&s->integrator);
    if (s->rigid != NULL) s->rigid->status = DEM_OK;
    if (s->surfaces == NULL) return;
    s->surfaces->status = DEM_OK;
    if (is_free(s)) surface_contact_bound_step(s->surfaces, y, y + state_velocities(&s->layout));
}

/* Those at closed contacts have been changed since. */
void body_contact_take_accelerations(dem_simulation *s, double sum)
{
    const bool is_known = s->automaton.set.forces.n_groups == 0;
    if (s->surfaces != NULL) approach_bound_take(&s->surfaces->bound, is_known ? sweep_largest(sum) : INFINITY);
}

void body_contact_end_step(dem_simulation *s)
{
    if (s->surfaces != NULL) approach_bound_end_step(&s->surfaces->bound, s->step);
}

void body_contact_begin_anew(dem_simulation *s)
{
    if (s->surfaces != NULL) approach_bound_forget(&s->surfaces->bound);
    guard_bound_forget(s);
}

dem_status body_contact_failure(const dem_simulation *s)
{
    const dem_status of_bodies = s->surfaces != NULL ? s->surfaces->status : DEM_OK;
    const dem_status of_rigid = s->rigid != NULL ? s->rigid->status : DEM_OK;
    return of_rigid == DEM_ERROR_MEMORY ? of_rigid : status_first(of_bodies, of_rigid);
}

/* ---- free flight ---- */

int body_contact_free_steps(const dem_simulation *s, int most)
{
    if (s->surfaces == NULL) return most;
    approach_bound b = s->surfaces->bound;
    int n = 0;
    while (n < most && approach_bound_pass_step(&b, s->options.fixed_step, b.at_start)) n++;
    return n;
}

/* Follows the bound along the steps.  \return whether it holds for them */
static bool pass_steps(approach_bound *b, const body_flight *flight)
{
    bool holds = true;
    for (int k = 0; k < flight->n && holds; k++)
        holds = approach_bound_pass_step(b, flight->t[k + 1] - flight->t[k], sweep_largest(flight->sum[k]));
    return holds;
}

bool body_contact_can_fly(const dem_simulation *s, const body_flight *flight)
{
    if (s->surfaces == NULL) return true;
    approach_bound b = s->surfaces->bound;
    return pass_steps(&b, flight);
}

/* What the last evaluation is asked for afterwards is that at the last end. */
void body_contact_fly(dem_simulation *s, const body_flight *flight)
{
    if (s->surfaces == NULL) return;
    (void)pass_steps(&s->surfaces->bound, flight);
    (void)surface_contact_evaluate(s->surfaces, flight->x);
}

/* ---- steps ---- */

/* Steps of a fixed length cannot be shortened by the loop. */
static const char *remedy(const dem_simulation *s)
{
    if (s->options.fixed_step > 0.0) return ": shorten fixed_step";
    return s->options.contact_thickness > 0.0 ? ": enlarge contact_thickness" : "";
}

/* The time of a part of the step, s. */
static double time_of(const dem_simulation *s, double part)
{
    return s->t + part * (s->path.end - s->t);
}

static dem_status refuse_crossing(const dem_simulation *s, const surface_crossing *crossing)
{
    const dem_index *nodes = crossing->pair.nodes, node = nodes[CONTACT_PAIR_NODE];
    const int32_t *body = s->model->lattice.body;
    const double *x = state_x(&s->layout, s->path.y0, node);
    return status_fail(DEM_ERROR_CONTACT,
                       "node %lld of body %d crosses the edge between nodes %lld and %lld of body %d near (%g, %g) m, "
                       "t = %.9g s%s",
                       (long long)model_node(s->model, node), body[node],
                       (long long)model_node(s->model, nodes[CONTACT_PAIR_FIRST]),
                       (long long)model_node(s->model, nodes[CONTACT_PAIR_SECOND]), body[nodes[CONTACT_PAIR_FIRST]],
                       x[0], x[1], time_of(s, crossing->part), remedy(s));
}

/* Whether rigid bodies have crossed obstacles in the step. */
static dem_status check_rigid(dem_simulation *s, const double *end)
{
    rigid_crossing at;
    if (s->rigid == NULL) return DEM_OK;
    const dem_status status = rigid_contact_check_step(s->rigid, s->path.y0, s->t, end, s->path.end, &at);
    if (status != DEM_ERROR_CONTACT) return status;
    s->crossings++;
    return status_fail(
        DEM_ERROR_CONTACT, "body %lld, which is rigid, crosses obstacle %lld near (%g, %g) m, t = %.9g s%s",
        (long long)at.body, (long long)at.obstacle, at.place.x, at.place.y, time_of(s, at.part), remedy(s));
}

/* Events may bring nodes into contact that were not near in the step: an adaptive step is then taken again, shorter; a
 * fixed one goes on, and the derivative at its end is evaluated anew. */
dem_status body_contact_check_step(dem_simulation *s)
{
    surface_crossing crossing;
    s->outgrown = false;
    if (s->surfaces == NULL) return DEM_OK;
    const double *end = s->path.y1;
    if (s->path.end < s->path.t1) {
        dense_output_state(&s->path, s->path.end, s->frame);
        end = s->frame;
    }
    const surface_contact_fault fault = surface_contact_check_step(s->surfaces, s->path.y0, end, &crossing);
    s->crossings += fault == SURFACE_CONTACT_CROSSED;
    if (fault == SURFACE_CONTACT_CROSSED) return refuse_crossing(s, &crossing);
    TRY(check_rigid(s, end));
    s->outgrown = fault == SURFACE_CONTACT_OUTGROWN;
    CHECK(!s->outgrown || s->options.fixed_step > 0.0, DEM_ERROR_CONTACT,
          "events in the step from t = %.9g s move surfaces of bodies too far", s->t);
    return DEM_OK;
}

/* ---- friction ---- */

/* The time of a state as integrated along, s. */
static double clock_of(const dem_simulation *s, const double *y)
{
    return y[state_velocities(&s->layout) + s->forces.clock];
}

/* Between all bodies, then of rigid bodies with obstacles. */
static dem_status settle(dem_simulation *s, const double *y)
{
    if (surface_contact_has_friction(s->surfaces)) TRY(surface_contact_settle(s->surfaces, y));
    if (rigid_contact_has_friction(s->rigid)) TRY(rigid_contact_settle(s->rigid, clock_of(s, y), y));
    return DEM_OK;
}

dem_status body_contact_settle(dem_simulation *s, const double *y)
{
    const bool has_friction = surface_contact_has_friction(s->surfaces) || rigid_contact_has_friction(s->rigid);
    return has_friction ? reduce_status(s->model->ranks, settle(s, y), 0.0) : DEM_OK;
}

void body_contact_forget(dem_simulation *s)
{
    if (s->surfaces != NULL) anchor_set_clear(&s->surfaces->anchors);
    for (dem_index k = 0; s->rigid != NULL && k < s->rigid->n; k++) anchor_set_clear(&s->rigid->list[k].anchors);
}

static dem_status make_records(anchor_record **out, dem_index n)
{
    *out = malloc((size_t)(n + 1) * sizeof **out);
    CHECK(*out != NULL, DEM_ERROR_MEMORY, "out of memory for %lld anchors", (long long)n);
    return DEM_OK;
}

/* \param d  in which nodes have their numbers, as in a checkpoint they have those of the whole; NULL: they are none */
static dem_status save_anchors(const anchor_set *anchors, const domain *d, const char *name, dem_checkpoint *checkpoint)
{
    anchor_record *list;
    TRY(make_records(&list, anchors->now.n));
    for (dem_index k = 0; k < anchors->now.n; k++) {
        list[k] = anchor_set_record(anchors, k);
        list[k].node = domain_number(d, list[k].node);
    }
    const dem_status status = dem_checkpoint_put(checkpoint, name, list, (size_t)anchors->now.n * sizeof *list);
    free(list);
    return status;
}

/* Anchors of a checkpoint; NULL: that of a run without friction. */
typedef struct saved_anchors {
    const anchor_record *list;
    dem_index n;
} saved_anchors;

static dem_status find_anchors(const dem_checkpoint *checkpoint, const char *name, saved_anchors *out)
{
    size_t size = 0;
    out->list = dem_checkpoint_find(checkpoint, name, &size);
    out->n = (dem_index)(size / sizeof *out->list);
    CHECK((size_t)out->n * sizeof *out->list == size, DEM_ERROR_IO,
          "the checkpoint has %zu bytes of %s, which has %zu bytes for each node", size, name, sizeof *out->list);
    return DEM_OK;
}

enum { NAME_LENGTH = 48 };

static const char of_bodies[] = "friction";

/* The entry with the anchors of a rigid body. */
static const char *name_entry(dem_index k, char name[NAME_LENGTH])
{
    (void)snprintf(name, NAME_LENGTH, "friction of rigid body %lld", (long long)k);
    return name;
}

static const char of_fillings[] = "fillings";

/* \param d  in which nodes have their numbers, as in a checkpoint they have those of the whole */
static dem_status save_fillings(const contact_surface *of, const domain *d, dem_checkpoint *checkpoint)
{
    const dem_index n = contact_surface_squeezed(of, NULL);
    squeezed_filling *list = malloc((size_t)(n + 1) * sizeof *list);
    CHECK(list != NULL, DEM_ERROR_MEMORY, "out of memory for %lld fillings", (long long)n);
    (void)contact_surface_squeezed(of, list);
    for (dem_index k = 0; k < n; k++) {
        list[k].first = domain_number(d, list[k].first);
        list[k].second = domain_number(d, list[k].second);
    }
    const dem_status status = dem_checkpoint_put(checkpoint, of_fillings, list, (size_t)n * sizeof *list);
    free(list);
    return status;
}

dem_status body_contact_save(const dem_simulation *s, dem_checkpoint *checkpoint)
{
    char name[NAME_LENGTH];
    if (s->surfaces != NULL && s->forces.elements != NULL)
        TRY(save_fillings(&s->surfaces->surface, s->model->domain, checkpoint));
    if (surface_contact_has_friction(s->surfaces))
        TRY(save_anchors(&s->surfaces->anchors, s->model->domain, of_bodies, checkpoint));
    for (dem_index k = 0; rigid_contact_has_friction(s->rigid) && k < s->rigid->n; k++)
        TRY(save_anchors(&s->rigid->list[k].anchors, NULL, name_entry(k, name), checkpoint));
    return DEM_OK;
}

/* The checkpoint of a run before there were any has none. Pairs in the lists are as of what was there before. */
static dem_status restore_fillings(surface_contact *of, const domain *d, const dem_checkpoint *checkpoint)
{
    size_t size = 0;
    const squeezed_filling *list = dem_checkpoint_find(checkpoint, of_fillings, &size);
    CHECK(size % sizeof *list == 0, DEM_ERROR_IO, "the checkpoint has %zu bytes of %s, which has %zu bytes for each",
          size, of_fillings, sizeof *list);
    const dem_index n = list != NULL ? (dem_index)(size / sizeof *list) : 0;
    if (n > 0 || contact_surface_squeezed(&of->surface, NULL) > 0) surface_contact_forget(of);
    squeezed_filling *own = malloc((size_t)(n + 1) * sizeof *own);
    CHECK(own != NULL, DEM_ERROR_MEMORY, "out of memory for %lld fillings", (long long)n);
    for (dem_index k = 0; k < n; k++)
        own[k] = (squeezed_filling){domain_node(d, list[k].first), domain_node(d, list[k].second), list[k].height};
    const dem_status status = contact_surface_squeeze(&of->surface, own, n);
    free(own);
    return status;
}

static dem_status restore_bodies(dem_simulation *s, const dem_checkpoint *checkpoint, const double *y)
{
    saved_anchors saved;
    anchor_record *list;
    TRY(find_anchors(checkpoint, of_bodies, &saved));
    if (saved.list == NULL) return DEM_OK;
    TRY(make_records(&list, saved.n));
    for (dem_index k = 0; k < saved.n; k++) {
        list[k] = saved.list[k];
        list[k].node = domain_node(s->model->domain, list[k].node);
    }
    const dem_status status = surface_contact_restore(s->surfaces, list, saved.n, y);
    free(list);
    return status;
}

static dem_status restore_rigid(dem_simulation *s, dem_index k, const dem_checkpoint *checkpoint, const double *y)
{
    char name[NAME_LENGTH];
    saved_anchors saved;
    TRY(find_anchors(checkpoint, name_entry(k, name), &saved));
    if (saved.list == NULL) return DEM_OK;
    return rigid_contact_restore(s->rigid, k, saved.list, saved.n, clock_of(s, y), y);
}

dem_status body_contact_restore(dem_simulation *s, const dem_checkpoint *checkpoint, const double *y)
{
    body_contact_forget(s);
    if (s->surfaces != NULL) TRY(restore_fillings(s->surfaces, s->model->domain, checkpoint));
    if (surface_contact_has_friction(s->surfaces)) TRY(restore_bodies(s, checkpoint, y));
    for (dem_index k = 0; rigid_contact_has_friction(s->rigid) && k < s->rigid->n; k++)
        TRY(restore_rigid(s, k, checkpoint, y));
    return body_contact_follow(s, y);
}

dem_surfaces body_contact_surfaces(const dem_simulation *s, const double *x)
{
    if (s->surfaces == NULL) return (dem_surfaces){.gap_min = INFINITY, .gap_share = INFINITY};
    const contact_surface *of = &s->surfaces->surface;
    const surface_gaps gaps = surface_contact_gaps(s->surfaces, x);
    return (dem_surfaces){.gap_min = gaps.least,
                          .gap_share = gaps.least_share,
                          .thickness_min = of->least.thickness,
                          .thickness_max = of->most.thickness,
                          .pushing = gaps.pushing,
                          .n_edges = of->surface.n_edges,
                          .left_out = s->surfaces->n_left_out,
                          .modulus_min = of->least.modulus,
                          .modulus_max = of->most.modulus,
                          .pressure_share = gaps.least_share < 1.0 ? contact_potential_pressure(gaps.least_share) : 0.0,
                          .friction_min = of->least.friction,
                          .friction_max = of->most.friction};
}

dem_status body_contact_list(dem_simulation *s, const double *x)
{
    return s->surfaces != NULL ? surface_load_list(&s->pushing, s->surfaces, x) : DEM_OK;
}

/* Halving a step that is stable would spoil the energy that fixed steps keep: with the default of 1/4 of the stability
 * bound contact needs no shorter steps until h omega is 1. A fixed step that is longer than that about the rest shape
 * was chosen so, and is shortened by what contact adds only. */
double body_contact_stiffening(dem_simulation *s, double guard, const double *y, bool is_known)
{
    const double h = s->options.fixed_step, rest = s->model->omega_max, omega = rest * guard;
    if (s->surfaces == NULL || !(h > 0.0)) return guard;
    const double most = fmax(1.0, h * rest), harmless = most * most / (h * h) - omega * omega;
    double added = surface_contact_stiffening(s->surfaces, s->model->inverse_mass, harmless, y, is_known);
    if (s->rigid != NULL) added += rigid_contact_stiffening(s->rigid, clock_of(s, y), y);
    return fmax(guard, h * sqrt(omega * omega + added) / most);
}
