/* SPDX-License-Identifier: BSD-3-Clause */
/* Resolves the events inside an accepted step one by one, in the order of (time, generation, kind, key), and corrects
 * the rest of the step after each (docs/algorithms.md, Local correction). The step's end y1, f1 changes with every
 * event; at the end closed contacts are put right and the accelerations near events are computed again, so that the
 * next step starts from the derivative of its very state. Going back in time means to undo all events of the step and
 * to resolve the first of them again: sources and corrections are deterministic, so the bits are the same. What an
 * event is, and what it does to a velocity, is in the sources (src/contact); how its change spreads is in
 * local_correction.c. */
#include "events/event_queue.h"

#include <math.h>
#include <stdlib.h>

#include "base/grow.h"
#include "base/status.h"

/* ---- set-up ---- */

/* `most` bounds the squared error of a step's events. With fixed steps there is no control of errors: it is
 * infinite. */
dem_status event_queue_create(event_queue *out, const event_queue_parts *parts)
{
    const state_layout *l = parts->layout;
    const local_forces *f = parts->forces;
    const constraints *c = parts->constraints;
    *out = (event_queue){.layout = *l,
                         .forces = f,
                         .constraints = c,
                         .sources = parts->sources,
                         .is_common = parts->is_common,
                         .happens = parts->happens,
                         .most = parts->controlled ? 1.0 : (double)INFINITY};
    dem_status status = changed_motion_create(&out->changed, l);
    if (status == DEM_OK) status = local_nodes_create(&out->renewed, l->n_nodes, 0);
    if (status == DEM_OK) status = local_correction_create(&out->correction, l, f, c, &parts->rule);
    if (status != DEM_OK) event_queue_destroy(out);
    return status;
}

void event_queue_destroy(event_queue *q)
{
    local_correction_destroy(&q->correction);
    changed_motion_destroy(&q->changed);
    local_nodes_destroy(&q->renewed);
    free(q->seeds);
    free(q->events);
    *q = (event_queue){0};
}

/* ---- the next event ---- */

/* The next event, and whose it is. */
typedef struct due_event {
    const event_source *source; /* NULL: there is none */
    event_due at;
} due_event;

/* Of equal ones that of the first source comes first, as only an earlier one replaces it. */
static due_event next_of(const event_queue *q)
{
    due_event first = {.at = {.t = (double)INFINITY}};
    for (dem_index kind = 0; kind < q->sources->n; kind++) {
        const event_source *source = &q->sources->list[kind];
        const event_due due = source->next(source->self);
        const bool at_once = due.t == first.at.t && due.generation < first.at.generation;
        if (due.t < first.at.t || (at_once && first.source != NULL)) first = (due_event){source, due};
    }
    return first;
}

/* From the start of the step: no event has been resolved, and each source finds its first one. */
static void look_ahead(event_queue *q)
{
    q->now = q->step->t0;
    q->error = q->ahead = (exact_sum){0};
    q->exceeded = false;
    q->settled = false;
    for (dem_index k = 0; k < q->sources->n; k++)
        q->sources->list[k].begin(q->sources->list[k].self, q->step, q->state);
}

void event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state)
{
    q->n_events = q->n_taken = 0;
    changed_motion_start(&q->changed, step->t1, y1, f1);
    step->changed = &q->changed;
    q->step = step;
    q->state = state;
    q->quiet = !q->happens;
    look_ahead(q);
}

bool event_queue_has_event(const event_queue *q)
{
    return !q->quiet && next_of(q).at.t <= q->step->t1;
}

/* Sources are undone from the last to the first, each of them all events of the step at once. */
void event_queue_undo(event_queue *q)
{
    if (q->n_taken == 0) return;
    for (dem_index k = q->sources->n - 1; k >= 0; k--) q->sources->list[k].undo(q->sources->list[k].self);
    changed_motion_undo(&q->changed);
    q->n_events = q->n_taken = 0;
}

/* ---- events ---- */

/* The listener that sources call: it keeps the event, to be reported when the loop has come to its time. */
static dem_status note_event(void *context, const dem_event *event)
{
    event_queue *q = context;
    CHECK(grow_array((void **)&q->events, &q->capacity, q->n_events + 1, sizeof *q->events), DEM_ERROR_MEMORY,
          "out of memory for the events of a step");
    q->events[q->n_events++] = *event;
    return DEM_OK;
}

/* Factor by which the square of a velocity's error grows if the step with the event were longer by the factor `ratio`:
 * the error goes with the sixth power of the length, its square with the twelfth. 0 for ratios of 4 and more, that is
 * for a next step that begins tau < h/4 after the event: its own estimate sees the error. That estimate is h^5 K^3 v
 * (tau (1/104 - 1/120) - h/2080), which vanishes for tau = 0.375 h; for tau < h/4 it is a sixth of the error or
 * more. */
static double growth(double ratio)
{
    const double third = ratio * ratio * ratio;
    return ratio < 4.0 ? third * third * third * third : 0.0;
}

/* The nodes that an event may change at once, into `seeds`; there are *n. */
static dem_status find_seeds(event_queue *q, const due_event *due, dem_index *n)
{
    const event_source *source = due->source;
    *n = source->seeds(source->self, due->at.key, q->seeds, q->seed_capacity);
    if (*n <= q->seed_capacity) return DEM_OK;
    CHECK(grow_array((void **)&q->seeds, &q->seed_capacity, *n, sizeof *q->seeds), DEM_ERROR_MEMORY,
          "out of memory for what is near an event");
    *n = source->seeds(source->self, due->at.key, q->seeds, q->seed_capacity);
    return DEM_OK;
}

/* Ranks go from common nodes to their neighbours, and so find the same, up to the first node that is none. */
static dem_status check_common(event_queue *q)
{
    const local_nodes *near = &q->correction.near.nodes;
    for (dem_index j = 0; j < near->n && q->is_common != NULL; j++) {
        q->lacks_nodes = !q->is_common[near->list[j]];
        CHECK(!q->lacks_nodes, DEM_STOPPED, "an event at t = %.9g s concerns nodes that not all ranks have", q->now);
    }
    return DEM_OK;
}

bool event_queue_lacks_nodes(const event_queue *q)
{
    return q->lacks_nodes;
}

/* Resolves an event, after all sources have prepared for it. */
static dem_status resolve(event_queue *q, const due_event *due, const event_place *at)
{
    const event_listener listener = {note_event, q};
    for (dem_index k = 0; k < q->sources->n; k++) q->sources->list[k].prepare(q->sources->list[k].self, at);
    return due->source->resolve(due->source->self, due->at.key, at, &listener);
}

/* Resolves an event and corrects the rest of the step for it:
 * - let the forces prepare for the step, if it is the first event in it;
 * - open the correction, before anything changes: it needs the motion and the forces without the event;
 * - let the sources prepare, and the one whose event it is resolve it in the state at that time;
 * - close the correction: integrate the change to the end of the step, and add it to the dense output;
 * - let the sources find the next events of what has moved. */
static dem_status take(event_queue *q, const due_event *due)
{
    const event_place at = {q->step, due->at.t, due->at.generation, &q->correction.near, q->state};
    dem_index n_seeds;
    double error;
    if (q->n_taken == 0) TRY(q->forces->begin_step(q->forces->self, q->step->y0, q->changed.y1));
    q->n_taken++;
    q->now = due->at.t;
    TRY(find_seeds(q, due, &n_seeds));
    const neighbourhood_seeds seeds = {q->seeds, n_seeds, due->source->changes_forces};
    TRY(local_correction_open(&q->correction, q->step, seeds, q->now, q->state));
    TRY(check_common(q));
    TRY(resolve(q, due, &at));
    if (due->source->changes_forces) TRY(q->forces->renew(q->forces->self, &q->correction.near.nodes));
    TRY(local_correction_close(&q->correction, q->step, &q->changed, q->state, &error));
    CHECK(isfinite(error), DEM_ERROR_INTEGRATOR, "the motion near node %lld after a %s event at t = %.9g s overflows",
          (long long)q->correction.near.nodes.list[0], due->source->name, q->now);
    exact_sum_add(&q->error, error);
    exact_sum_add(&q->ahead, error * growth((q->step->t1 - q->step->t0) / q->correction.h));
    q->exceeded = error > q->most;
    for (dem_index k = 0; k < q->sources->n; k++) q->sources->list[k].follow(q->sources->list[k].self, &at);
    return DEM_OK;
}

/* Computes the acceleration of node i at the end of the step again, from the new positions of the node and its
 * neighbours, unless it is known: that of its group if closed contacts hold it, else that of its forces. Prescribed
 * components keep what is given. x' is the velocity again, but where some component of the node is prescribed. */
static void renew(event_queue *q, dem_index i, const double *known)
{
    const state_layout *l = &q->layout;
    const constraints *c = q->constraints;
    const unsigned held = local_forces_held(q->forces, i);
    double *u = q->changed.f1 + state_row(l, i), *a = u + state_velocities(l), now[STATE_DIM_MOST];
    if (constraints_group_at(c, i) >= 0)
        state_copy_row(l, now, *c->a + state_row(l, i));
    else if (known != NULL)
        state_copy_row(l, now, known);
    else
        q->forces->accelerate_one(q->forces->self, i, q->changed.y1, now);
    for (int d = 0; d < l->dim; d++)
        if (!(held & ((unsigned)DEM_COMPONENT_X << d))) a[d] = now[d];
    if (held == 0) state_copy_row(l, u, state_v(l, q->changed.y1, i));
}

/* Computes the rates of the quadratures again that closed contacts contribute to: impulses, friction, obstacles. They
 * are zeroed and summed up over all contacts, and friction between nodes, as the right-hand side does. The rows are
 * kept first, for undo. */
static dem_status renew_rates(event_queue *q)
{
    const state_layout *l = &q->layout;
    const local_forces *f = q->forces;
    const constraints *c = q->constraints;
    const dem_index first = state_impulse(l, 0), last = state_total_rows(l);
    const dem_index work = state_total_index(l, STATE_OBSTACLE);
    double *a = q->changed.f1 + state_velocities(l);
    for (dem_index row = first; row <= last; row++) TRY(changed_motion_keep(&q->changed, row));
    for (dem_index k = state_row(l, first); k <= state_total_index(l, STATE_FRICTION); k++) a[k] = 0.0;
    if (state_has_total(l, STATE_OBSTACLE)) {
        TRY(changed_motion_keep(&q->changed, work / l->dim));
        a[work] = 0.0;
    }
    if (c != NULL) c->add_all_rates(c->self, (constraint_state){q->step->t1, q->changed.y1}, a);
    if (f->friction_power != NULL) a[state_total_index(l, STATE_FRICTION)] += f->friction_power(f->self, q->changed.y1);
    return DEM_OK;
}

/* Lists the nodes whose motion events have changed. */
static dem_status list_changed(event_queue *q)
{
    local_nodes *nodes = &q->renewed;
    local_nodes_clear(nodes);
    for (dem_index e = 0; e < q->changed.n; e++)
        if (q->changed.list[e].node < q->layout.n_nodes) TRY(local_nodes_add(nodes, q->changed.list[e].node));
    return DEM_OK;
}

/* Accelerations that are known of nodes beside these groups are no longer those of the end of the step. */
static dem_status doubt_groups(event_queue *q, const dem_index *groups, dem_index n)
{
    const constraints *c = q->constraints;
    local_nodes *nodes = &q->renewed;
    local_nodes_clear(nodes);
    for (dem_index g = 0; g < n; g++) TRY(c->each_node(c->self, groups[g], local_nodes_add_to, nodes));
    TRY(q->forces->add_neighbours(q->forces->self, nodes, 0, nodes->n));
    for (dem_index j = 0; j < nodes->n; j++) changed_motion_doubt(&q->changed, nodes->list[j]);
    return DEM_OK;
}

/* Closed contacts whose nodes events have moved are put back on their surfaces and stopped there, which removes the
 * error that the corrections have left in them. */
static dem_status settle_groups(event_queue *q)
{
    const constraints *c = q->constraints;
    const dem_index *groups;
    if (c == NULL) return DEM_OK;
    TRY(list_changed(q));
    const dem_index n = c->groups_at(c->self, q->renewed.list, q->renewed.n, &groups);
    for (dem_index g = 0; g < n; g++) c->settle(c->self, groups[g], q->step->t1, q->changed.y1);
    return n > 0 ? doubt_groups(q, groups, n) : DEM_OK;
}

/* Solves for the groups that have nodes among those to be renewed, and adds their other nodes to these. The forces of
 * other groups are what they were before the events. Not so by Verlet's method: there the derivative at the end of the
 * step is that at the velocities v_0 + h a_0, but rates are to have the velocities of the state. */
static dem_status solve_groups(event_queue *q)
{
    const constraints *c = q->constraints;
    local_nodes *nodes = &q->renewed;
    const dem_index *groups;
    if (c == NULL) return DEM_OK;
    if (q->step->parabolic) TRY(c->each_held(c->self, local_nodes_add_to, nodes));
    const dem_index n = c->groups_at(c->self, nodes->list, nodes->n, &groups);
    for (dem_index g = 0; g < n; g++) {
        c->solve(c->self, groups[g], (constraint_state){q->step->t1, q->changed.y1}, NULL);
        TRY(c->each_node(c->self, groups[g], local_nodes_add_to, nodes));
    }
    return DEM_OK;
}

/* Computes the derivative at the end of the step again where nodes have changed, at the neighbours of these nodes,
 * whose accelerations depend on them, and at all nodes of their groups: it is that of the state to the bit, but for the
 * power of damping and boundaries. The next step can therefore begin without an evaluation of all forces. */
static dem_status renew_end(event_queue *q)
{
    const local_forces *f = q->forces;
    local_nodes *nodes = &q->renewed;
    TRY(list_changed(q));
    const dem_index n_changed = nodes->n;
    TRY(f->add_neighbours(f->self, nodes, 0, n_changed));
    TRY(solve_groups(q));
    for (dem_index j = n_changed; j < nodes->n; j++) TRY(changed_motion_keep(&q->changed, nodes->list[j]));
    for (dem_index j = 0; j < nodes->n; j++)
        renew(q, nodes->list[j], changed_motion_known(&q->changed, nodes->list[j]));
    return renew_rates(q);
}

/* Closed contacts first, then the derivative. */
static dem_status settle_end(event_queue *q)
{
    changed_motion_end_rows(&q->changed);
    TRY(settle_groups(q));
    q->settled = true;
    return renew_end(q);
}

/* The errors of several events are independent: their squares are summed. The sums are exact, so that the order of
 * events at different places decides about no step. */
double event_queue_error(const event_queue *q)
{
    return isfinite(q->most) && !q->quiet ? sqrt(exact_sum_value(&q->error) / q->most) : 0.0;
}

/* The length for which the events' error, as it would be at the start of a step, is 1: the error is taken to go with
 * its fourth power, which is slower than it does, and so on the safe side. */
double event_queue_reach(const event_queue *q)
{
    const double error = isfinite(q->most) && !q->quiet ? sqrt(exact_sum_value(&q->ahead) / q->most) : 0.0;
    return error > 1.0 ? (q->step->t1 - q->step->t0) / sqrt(sqrt(error)) : (double)INFINITY;
}

/* Resolves the events up to t, or goes back to t. In a step without events (quiet) there is nothing to do. Resolution
 * ends at t, or with an event whose error alone exceeds what is allowed: the caller then rejects the step. That the sum
 * exceeds it does not end it, as the sum of a part of the events depends on their order where that is of no account. */
dem_status event_queue_show(event_queue *q, double t)
{
    if (q->quiet) return DEM_OK;
    if (t < q->now) {
        event_queue_undo(q);
        look_ahead(q);
    }
    dem_status status = DEM_OK;
    due_event due;
    while (status == DEM_OK && (due = next_of(q)).source != NULL && due.at.t <= t && !q->exceeded)
        status = take(q, &due);
    TRY(status);
    q->now = t;
    if (t < q->step->t1) return DEM_OK;
    q->quiet = q->n_taken == 0;
    return q->quiet || q->settled ? DEM_OK : settle_end(q);
}
