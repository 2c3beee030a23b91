/* SPDX-License-Identifier: BSD-3-Clause */
/* The moving state and the time loop. An accepted step is first taken (`path` is then in hand), shown to the
 * observers whose frames fall into it, and committed: its end becomes the state, the contacts change, and the next
 * step is taken. An advance to t_end stops within a step in hand, which the next advance goes on with: t_end is
 * never stepped to. */
#include <stdlib.h>
#include <string.h>

#include "base/aligned.h"
#include "base/record.h"
#include "base/status.h"
#include "contact/automaton_step.h"
#include "forces/diagnostics.h"
#include "simulation/checkpoint.h"
#include "simulation/options.h"
#include "simulation/query.h"

enum {
    between_looks = 16, /* accepted steps, for overlaps */
    most_attempts = 30  /* at a step whose contacts reject it */
};

static const double safety = 0.9, least_factor = 0.1; /* of the next step after one that contacts have rejected */

/* ---- what the integrator asks ---- */

static dem_status name_culprit(const dem_simulation *s, double t, const double *y, const double *a)
{
    const double *v = y + state_velocities(&s->layout);
    for (dem_index i = 0; i < s->model->lattice.n_nodes; i++)
        if (!isfinite(v[2 * i]) || !isfinite(v[2 * i + 1]) || !isfinite(a[2 * i]) || !isfinite(a[2 * i + 1]))
            return status_fail(DEM_ERROR_INTEGRATOR,
                               "force or velocity of node %lld is not finite at (%g, %g) m, t = %.9g s", (long long)i,
                               y[2 * i], y[2 * i + 1], t);
    return status_fail(DEM_ERROR_INTEGRATOR, "forces overflow at t = %.9g s", t);
}

/* Rates of the quadratures, behind the accelerations of the nodes. */
static void fill_rates(dem_simulation *s, const double *y, double *a, double work)
{
    const state_layout *l = &s->layout;
    const double *v = y + state_velocities(l);
    for (dem_index k = state_row(l, l->n_nodes); k < state_velocities(l); k++) a[k] = 0.0;
    automaton_add_rates(&s->automaton, y, a);
    if (s->damped)
        a[state_total_index(l, STATE_DAMPING)] =
            diagnostics_damping_power(s->model, &s->automaton.set.scene.rule.load, y, v);
    a[state_total_index(l, STATE_WORK)] = work;
    a[state_total_index(l, STATE_TIME)] = 1.0;
}

/* y = (x, v), f = (v, a) with m a = F(x, v) + m g, less what the closed contacts hold; prescribed components are given.
 *                                                                                                        (3), (4) */
static int derivative(double t, const double *y, double *u, double *a, void *context)
{
    dem_simulation *s = context;
    const dem_index n = state_velocities(&s->layout), n_real = state_row(&s->layout, s->layout.n_nodes);
    const double *v = y + n;
    const kernel_state nodes = {.x = y, .v = v, .u = u, .a = a};
    const double sum = kernel_accelerate(&s->kernel, &s->automaton.set.scene.rule.load, &nodes);
    for (dem_index k = n_real; k < n && u != NULL; k++) u[k] = v[k];
    automaton_constrain(&s->automaton, y, a);
    const double work = boundary_conditions_prescribe(&s->boundaries, s->model->lattice.mass, t, v, u, a);
    fill_rates(s, y, a, s->external != NULL ? work + external_force_power(s->external, v) : work);
    if (external_force_failed(s->external)) return 2;
    if (isfinite(sum)) return 0;
    (void)name_culprit(s, t, y, a);
    return 1;
}

/* Where nothing but springs, triangles and weight acts. */
static int take_fused_step(const ode_fused_step *step, void *context)
{
    dem_simulation *s = context;
    const forces *load = &s->automaton.set.scene.rule.load;
    const dem_index n = state_velocities(&s->layout);
    const sweep_fused_step nodes = {
        .h = step->h, .x0 = step->y0, .v0 = step->y0 + n, .a0 = step->f0 + n, .x1 = step->y1, .v1 = step->y1 + n};
    const kernel_state y = {.x = nodes.x1, .v = nodes.v1, .a = step->f1 + n, .fused_step = &nodes};
    if (!kernel_can_fuse(&s->kernel, load) || s->automaton.set.forces.n_groups > 0) return -1;
    const double sum = kernel_accelerate(&s->kernel, load, &y);
    automaton_constrain(&s->automaton, y.x, y.a);
    fill_rates(s, y.x, y.a, 0.0);
    if (isfinite(sum)) return 0;
    (void)name_culprit(s, step->t1, y.x, y.a);
    return 1;
}

static void root_functions(double t, const double *y, double *g, void *context)
{
    dem_simulation *s = context;
    automaton_root_functions(&s->automaton, t, y, g);
}

static double stiffening(const double *y, void *context)
{
    dem_simulation *s = context;
    return kernel_stiffening(&s->kernel, y);
}

/* An event at which the whole body has stopped. */
static dem_status hear_event(void *context, const dem_event *event)
{
    dem_simulation *s = context;
    query_at(s, s->t, s->y);
    return observers_event(&s->observers, s, event);
}

/* Events inside the step in hand, up to t. */
static dem_status tell_events(dem_simulation *s, double t)
{
    dem_status status = DEM_OK;
    if (!observers_want_events(&s->observers)) return DEM_OK;
    while (s->told < s->n_inside && s->queue.events[s->told].t <= t) {
        const dem_event event = s->queue.events[s->told++];
        query_inside(s, event.t);
        status = status_first(status, observers_event(&s->observers, s, &event));
    }
    return status;
}

static dem_status tell_step(dem_simulation *s)
{
    query_at(s, s->t, s->y);
    return observers_step(&s->observers, s);
}

static dem_status tell_frames(dem_simulation *s, double t_end)
{
    double t;
    for (int k = 0; (k = observers_due(&s->observers, s->path.end, t_end, &t)) >= 0;) {
        TRY(tell_events(s, t));
        query_inside(s, t);
        TRY(observers_frame(&s->observers, k, s));
    }
    return DEM_OK;
}

/* ---- the loop ---- */

/* Nothing goes on that a force from outside has not been there for. */
static dem_status stop_if_force_failed(const dem_simulation *s, dem_status status)
{
    return external_force_failed(s->external) ? DEM_STOPPED : status;
}

/* Keeps the state with its contacts, which are about to change at once. */
static dem_status take_rollback(dem_simulation *s)
{
    if (s->external == NULL) return DEM_OK;
    if (s->rollback == NULL) TRY(dem_record_create(&s->rollback));
    TRY(checkpoint_take(s, s->rollback));
    s->has_rollback = true;
    return DEM_OK;
}

/* The force from outside has failed: back to the last state that it was there for. */
static dem_status roll_back(dem_simulation *s)
{
    dem_status status = DEM_OK;
    if (s->in_hand) event_queue_undo(&s->queue);
    s->in_hand = s->at_event = false;
    if (s->has_rollback)
        status = checkpoint_restore(s, s->rollback);
    else
        status = integrator_restart(&s->integrator, s->t, s->y);
    s->has_rollback = false;
    query_at(s, s->t, s->y);
    return status_first(status, external_force_failure(s->external));
}

/* What the next try of a step is shortened by: its error is too large, or its events fail, which they may if it is much
 * too long. */
static double shortening(const event_queue *q, dem_status status)
{
    const double error = event_queue_error(q);
    if (status == DEM_ERROR_CONTACT || status == DEM_ERROR_INTEGRATOR) return least_factor;
    return status == DEM_OK && error > 1.0 ? fmax(least_factor, safety / sqrt(sqrt(error))) : 1.0;
}

/* Takes back a step that will not do: the next goes from its start. */
static dem_status give_up(dem_simulation *s, dem_status status)
{
    if (status == DEM_OK)
        status = status_fail(DEM_ERROR_INTEGRATOR,
                             "contact events in the step from t = %.9g s fail its error test: rtol may be out of reach",
                             s->t);
    return status_first(status, integrator_restart(&s->integrator, s->t, s->y));
}

/* A step with all contact events inside it, which may reject it. */
static dem_status take_local_step(dem_simulation *s)
{
    bool rooted;
    double *y1, *f1;
    for (int attempt = 1;; attempt++) {
        TRY(integrator_step(&s->integrator, &s->path, &rooted));
        integrator_end(&s->integrator, &y1, &f1);
        event_queue_start(&s->queue, &s->path, y1, f1, s->frame);
        const dem_status status = stop_if_force_failed(s, event_queue_show(&s->queue, s->path.t1));
        const double factor = shortening(&s->queue, status);
        if (status == DEM_OK && factor == 1.0) return DEM_OK;
        event_queue_undo(&s->queue);
        if (s->options.fixed_step > 0.0 || attempt == most_attempts || factor == 1.0) return give_up(s, status);
        TRY(integrator_redo(&s->integrator, factor));
    }
}

/* A step to the first contact event in it. */
static dem_status take_step_to_event(dem_simulation *s)
{
    bool rooted;
    TRY(integrator_step(&s->integrator, &s->path, &rooted));
    s->at_event = automaton_check_step(&s->automaton, &s->path, rooted, s->frame) || rooted;
    return stop_if_force_failed(s, DEM_OK);
}

static dem_status take_step(dem_simulation *s)
{
    TRY(run_is_local(s) ? take_local_step(s) : take_step_to_event(s));
    s->n_inside = s->queue.n_events;
    s->told = 0;
    s->in_hand = true;
    return DEM_OK;
}

/* The contacts of the state have changed, with this status, and v has jumped: from there the integrator goes on. */
static dem_status go_on(dem_simulation *s, dem_status status)
{
    TRY(stop_if_force_failed(s, DEM_OK));
    s->has_rollback = false;
    status = status_first(status, integrator_restart(&s->integrator, s->t, s->y));
    return status == DEM_ERROR_CONTACT ? status : status_first(status, tell_step(s));
}

static void look_for_overlaps(dem_simulation *s)
{
    overlap_look(&s->overlap, &s->model->lattice, s->t, s->y);
    s->unlooked = 0;
}

/* The end of the step in hand becomes the state.  \return whether vertex contacts were put back */
static bool settle_step(dem_simulation *s)
{
    const dense_output *p = &s->path;
    integrator_settle(&s->integrator, p);
    s->y = integrator_state(&s->integrator);
    const bool moved = automaton_project(&s->automaton, p->end, s->y);
    automaton_end_step(&s->automaton, p, s->y);
    s->step = p->end - s->t;
    s->t = p->end;
    s->in_hand = false;
    s->unrecorded++;
    if (++s->unlooked >= between_looks) look_for_overlaps(s);
    return moved;
}

static dem_status commit_step_to_event(dem_simulation *s)
{
    const event_listener listener = {hear_event, s};
    if (s->at_event) TRY(take_rollback(s));
    const bool moved = settle_step(s);
    if (!s->at_event && moved) TRY(integrator_restart(&s->integrator, s->t, s->y));
    if (!s->at_event) return tell_step(s);
    s->events++;
    return go_on(s, automaton_resolve(&s->automaton, s->t, s->y, &listener)); /* (8), (9) */
}

static dem_status commit_local_step(dem_simulation *s)
{
    TRY(tell_events(s, s->path.t1));
    TRY(stop_if_force_failed(s, event_queue_show(&s->queue, s->path.t1)));
    const bool moved = settle_step(s), corrected = s->queue.n_stops > 0;
    s->events += s->queue.n_stops;
    TRY(integrator_bound(&s->integrator, event_queue_reach(&s->queue)));
    if (moved)
        TRY(integrator_restart(&s->integrator, s->t, s->y));
    else if (corrected)
        TRY(integrator_resume(&s->integrator));
    return tell_step(s);
}

static dem_status commit_step(dem_simulation *s)
{
    return run_is_local(s) ? commit_local_step(s) : commit_step_to_event(s);
}

/* Contacts of the initial state come before the first step, when the observers are there to be told. */
static dem_status start(dem_simulation *s)
{
    const event_listener listener = {hear_event, s};
    TRY(take_rollback(s));
    const dem_status status = go_on(s, automaton_start(&s->automaton, s->t, s->y, &listener));
    s->started = !external_force_failed(s->external);
    return status;
}

static bool wants_record(const dem_simulation *s)
{
    const dem_index every = s->options.record_steps;
    return every > 0 && (!s->has_record || s->unrecorded >= every);
}

/* A run goes on from its record as one does that is resumed. */
static dem_status take_record(dem_simulation *s)
{
    s->has_record = false;
    TRY(checkpoint_take(s, s->record));
    TRY(checkpoint_restore(s, s->record));
    s->has_record = true;
    query_at(s, s->t, s->y);
    return observers_record(&s->observers, s, s->record);
}

static dem_status advance(dem_simulation *s, double t_end)
{
    if (!s->started) TRY(start(s));
    for (;;) {
        if (!s->in_hand && wants_record(s)) TRY(take_record(s));
        if (!s->in_hand) TRY(take_step(s));
        TRY(stop_if_force_failed(s, tell_frames(s, t_end)));
        if (t_end < s->path.end) break;
        TRY(commit_step(s));
    }
    TRY(tell_events(s, t_end));
    query_inside(s, t_end);
    return DEM_OK;
}

dem_status dem_simulation_advance(dem_simulation *s, double t_end)
{
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_advance: simulation is NULL");
    CHECK(isfinite(t_end) && t_end >= s->seen_t, DEM_ERROR_ARGUMENT, "t_end = %g s is before the present time %g s",
          t_end, s->seen_t);
    s->advanced = s->advancing = true;
    const dem_status status = advance(s, t_end);
    s->advancing = false;
    return external_force_failed(s->external) ? roll_back(s) : status;
}

/* ---- set-up ---- */

static dem_status allocate(dem_simulation *s)
{
    const size_t n = (size_t)state_size(&s->layout);
    s->y = s->initial = aligned_zeros(n);
    s->frame = malloc(n * sizeof *s->frame);
    s->contacts = calloc(2 * (size_t)(s->model->n_contact_nodes + s->model->surface.n_edges) + 1, sizeof *s->contacts);
    s->measures = calloc(1, sizeof *s->measures);
    CHECK(s->y && s->frame && s->contacts && s->measures, DEM_ERROR_MEMORY, "out of memory for the state of %lld nodes",
          (long long)s->model->lattice.n_nodes);
    return DEM_OK;
}

static contact_rule rule_of(const dem_simulation *s)
{
    const dem_model *model = s->model;
    const dem_options *o = &s->options;
    return (contact_rule){.penetration_tolerance = o->penetration_tolerance,
                          .position_error = o->rtol * o->spacing,
                          .rest_speed = o->rest_speed,
                          .window = o->window,
                          .max_step = o->max_step,
                          .storm_time = model->omega_max > 0.0 ? 1.0 / model->omega_max : 2.0 * o->max_step,
                          .max_impacts = o->max_impacts,
                          .vertices = o->vertices != 0,
                          .layout = s->layout,
                          .n_threads = o->threads,
                          .load = run_load(s)};
}

static dem_status set_up(dem_simulation *s)
{
    const dem_model *model = s->model;
    const dem_options *o = &s->options;
    const size_t block = (size_t)state_row(&s->layout, model->lattice.n_nodes) * sizeof *s->y;
    TRY(boundary_conditions_compile(&s->boundaries, o->boundaries, o->n_boundaries, &model->lattice,
                                    model->obstacles.n));
    s->options.boundaries = NULL;
    TRY(external_force_create(&s->external, o, model->lattice.n_nodes));
    TRY(options_fill(&s->options, model, &s->boundaries));
    TRY(allocate(s));
    memcpy(s->y, model->lattice.position, block);
    memcpy(s->y + state_velocities(&s->layout), model->lattice.velocity, block);
    boundary_conditions_begin(&s->boundaries, s->y + state_velocities(&s->layout));
    TRY(kernel_create(&s->kernel, model, o->kernel, o->threads));
    s->options.kernel = s->kernel.kind;
    const contact_rule rule = rule_of(s);
    s->damped = model->springs.viscosity != NULL || o->mass_damping > 0.0;
    TRY(automaton_create(&s->automaton, model, &rule));
    TRY(automaton_check_start(&s->automaton, s->y));
    dem_method_traits method;
    TRY(dem_method_describe(&method, o->method));
    const local_correction_rule near = {method.order, o->rtol * o->spacing, o->rtol * o->v_scale, s->boundaries.held};
    if (run_is_local(s)) TRY(event_queue_create(&s->queue, &s->automaton, &near, !(o->fixed_step > 0.0)));
    const ode_problem problem = {
        .n_nodes = s->layout.n_rows,
        .n_quadratures = s->layout.n_rows - s->layout.n_nodes,
        .n_roots = model->obstacles.n > 0 && !run_is_local(s) ? CANDIDATE_ROOTS * s->automaton.set.n : 0,
        .prescribes = boundary_conditions_move(&s->boundaries),
        .derivative = derivative,
        .fused_step = s->boundaries.n == 0 ? take_fused_step : NULL,
        .root_functions = root_functions,
        .stiffening = stiffening,
        .context = s,
        .method = o->method,
        .position_error = o->rtol * o->spacing,
        .velocity_error = o->rtol * o->v_scale,
        .max_step = o->max_step,
        .fixed_step = o->fixed_step,
        .ops = s->kernel.ops,
        .n_threads = s->kernel.n_threads};
    TRY(integrator_create(&s->integrator, &problem, 0.0, s->y));
    s->y = integrator_state(&s->integrator);
    free(s->initial);
    s->initial = NULL;
    TRY(dem_record_create(&s->record));
    TRY(overlap_create(&s->overlap, &model->lattice));
    look_for_overlaps(s);
    query_at(s, 0.0, s->y);
    return DEM_OK;
}

static dem_status resume(dem_simulation *s, const dem_record *record)
{
    TRY(checkpoint_restore(s, record));
    if (external_force_failed(s->external)) return external_force_failure(s->external);
    s->started = s->has_record = true;
    query_at(s, s->t, s->y);
    return record_copy(s->record, record);
}

static dem_status create(dem_simulation **out, const dem_model *model, const dem_options *options,
                         const dem_record *record)
{
    CHECK(out != NULL && model != NULL && options != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_create: %s is NULL",
          out == NULL ? "out" : (model == NULL ? "model" : "options"));
    TRY(options_check(options));
    dem_simulation *s = calloc(1, sizeof *s);
    CHECK_MEMORY(s);
    s->model = model;
    s->options = *options;
    s->layout = state_layout_of(model->lattice.dim, model->lattice.n_nodes, model->obstacles.n);
    dem_status status = set_up(s);
    if (status == DEM_OK && record != NULL) status = resume(s, record);
    if (status == DEM_OK)
        *out = s;
    else
        dem_simulation_destroy(s);
    return status;
}

dem_status dem_simulation_create(dem_simulation **out, const dem_model *model, const dem_options *options)
{
    return create(out, model, options, NULL);
}

dem_status dem_simulation_resume(dem_simulation **out, const dem_model *model, const dem_options *options,
                                 const dem_record *record)
{
    CHECK(record != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_resume: record is NULL");
    return create(out, model, options, record);
}

void dem_simulation_destroy(dem_simulation *s)
{
    if (s == NULL) return;
    integrator_destroy(&s->integrator);
    kernel_destroy(&s->kernel);
    event_queue_destroy(&s->queue);
    automaton_destroy(&s->automaton);
    boundary_conditions_free(&s->boundaries);
    external_force_destroy(s->external);
    overlap_destroy(&s->overlap);
    free(s->initial);
    free(s->frame);
    free(s->contacts);
    free(s->measures);
    dem_record_destroy(s->record);
    dem_record_destroy(s->rollback);
    free(s);
}

dem_status dem_simulation_observe(dem_simulation *s, const dem_observer *observer)
{
    CHECK(s != NULL && observer != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_observe: %s is NULL",
          s == NULL ? "simulation" : "observer");
    CHECK(!s->advanced, DEM_ERROR_ARGUMENT, "observers come before the first advance");
    return observers_add(&s->observers, observer, integrator_counts(&s->integrator).steps > 0 ? s->t : -1.0);
}
