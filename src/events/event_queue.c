/* SPDX-License-Identifier: BSD-3-Clause */
/* Who is next; what has changed. */
#include "events/event_queue.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/status.h"
#include "base/threads.h"
#include "contact/automaton_step.h"
#include "contact/impact_group.h"

/* ---- set-up ---- */

static dem_status allocate(event_queue *q, const dem_model *model)
{
    const size_t n = (size_t)q->automaton->set.n + 1;
    q->crossing = malloc(n * sizeof *q->crossing);
    q->kept = calloc(n, sizeof *q->kept);
    q->saved = malloc(n * sizeof *q->saved);
    q->before = malloc(n * sizeof *q->before);
    CHECK(q->crossing && q->kept && q->saved && q->before, DEM_ERROR_MEMORY, "out of memory for %lld contact sites",
          (long long)q->automaton->set.n);
    TRY(event_heap_create(&q->heap, q->automaton->set.n));
    TRY(changed_motion_create(&q->changed, scene_layout(&q->automaton->set.scene)));
    return ledger_create(&q->ledger, model->obstacles.n);
}

dem_status event_queue_create(event_queue *out, automaton *c, const local_correction_rule *rule, bool controlled)
{
    event_queue q = {.automaton = c, .most = controlled ? 1.0 : (double)INFINITY};
    dem_status status = allocate(&q, c->set.scene.model);
    if (status == DEM_OK) status = local_correction_create(&q.correction, &c->set, rule);
    if (status == DEM_OK)
        *out = q;
    else
        event_queue_destroy(&q);
    return status;
}

void event_queue_destroy(event_queue *q)
{
    local_correction_destroy(&q->correction);
    changed_motion_destroy(&q->changed);
    ledger_destroy(&q->ledger);
    event_heap_destroy(&q->heap);
    free(q->crossing);
    free(q->kept);
    free(q->saved);
    free(q->before);
    free(q->seeds);
    free(q->events);
    *q = (event_queue){0};
}

/* ---- who is next ---- */

enum { least_share = 32 }; /* free sites for which a thread is worth its while */

static bool is_free(const event_queue *q, dem_index k)
{
    return q->automaton->set.list[k].n_closed == 0;
}

/* When the free ones of a share of the sites touch. */
static void look_at_free(event_queue *q, int n_shares, int share)
{
    automaton *c = q->automaton;
    const dem_index n = automaton_n_active(c), end = threads_share(n, n_shares, share + 1);
    for (dem_index a = threads_share(n, n_shares, share); a < end; a++) {
        const dem_index k = automaton_active_candidate(c, a);
        if (is_free(q, k)) q->crossing[k] = automaton_crossing(c, q->step, k, q->step->t0);
    }
}

static void look_ahead(event_queue *q)
{
    automaton *c = q->automaton;
    const dense_output *step = q->step;
    event_heap_clear(&q->heap);
    q->now = step->t0;
    q->error = q->ahead = 0.0;
    q->settled = false;
    automaton_begin_step(c, step, q->state);
    const int most = c->set.scene.rule.n_threads,
              n_threads = automaton_n_active(c) >= least_share * most && most > 1 ? most : 1;
    THREADS_RUN(n_threads, t, look_at_free(q, n_threads, t));
    const dem_index *behind = &c->set.ledger.counts.behind, were_behind = *behind;
    for (dem_index a = 0; a < automaton_n_active(c); a++) {
        const dem_index k = automaton_active_candidate(c, a);
        const bool known =
            is_free(q, k) && q->crossing[k] > step->t0 && *behind == were_behind; /* else others may know more */
        event_heap_set(&q->heap, k, known ? q->crossing[k] : automaton_next_change(c, step, k, step->t0, q->state));
    }
}

void event_queue_start(event_queue *q, dense_output *step, double *y1, double *f1, double *state)
{
    for (dem_index s = 0; s < q->n_saved; s++) q->kept[q->saved[s]] = false;
    q->n_saved = q->n_events = q->n_stops = 0;
    changed_motion_start(&q->changed, step->t1, y1, f1);
    step->changed = &q->changed;
    q->step = step;
    q->state = state;
    q->idle = q->automaton->idle;
    q->quiet = false;
    look_ahead(q);
}

/* ---- what has changed ---- */

static void copy_books(const contact_ledger *from, contact_ledger *to, dem_index n_obstacles)
{
    double *const impulse = to->impulse, *const friction_impulse = to->friction_impulse;
    memcpy(impulse, from->impulse, 4 * (size_t)n_obstacles * sizeof *impulse);
    *to = *from;
    to->impulse = impulse;
    to->friction_impulse = friction_impulse;
}

static void keep_site(event_queue *q, dem_index k)
{
    if (q->kept[k]) return;
    q->kept[k] = true;
    q->saved[q->n_saved] = k;
    q->before[q->n_saved++] = q->automaton->set.list[k];
}

static dem_index n_moving(const event_queue *q)
{
    return q->correction.near.end[q->correction.near.n_rings - 1];
}

static bool moves(const event_queue *q, dem_index node)
{
    return neighbourhood_has(&q->correction.near, node, q->correction.near.n_rings - 1);
}

/* Does something to every site that has a node in the patch which moves. */
static void each_site(event_queue *q, void (*act)(event_queue *q, dem_index k))
{
    const contact_set *c = &q->automaton->set;
    const surface *s = &c->scene.model->surface;
    for (dem_index j = 0; j < n_moving(q); j++) {
        const dem_index i = q->correction.near.nodes[j].i;
        if (c->of_node[i] >= 0) act(q, c->of_node[i]);
        for (dem_index p = s->row[i]; p < s->row[i + 1] && c->n > c->scene.model->n_contact_nodes; p++) {
            const dem_index k = contact_set_of_edge(c, s->at[p]);
            if (c->list[k].node == i || !moves(q, c->list[k].node)) act(q, k); /* once */
        }
    }
}

void event_queue_undo(event_queue *q)
{
    automaton *c = q->automaton;
    if (q->n_stops == 0) return;
    for (dem_index s = 0; s < q->n_saved; s++) {
        c->set.list[q->saved[s]] = q->before[s];
        q->kept[q->saved[s]] = false;
    }
    copy_books(&q->ledger, &c->set.ledger, c->set.scene.model->obstacles.n);
    (void)contact_set_regroup_some(&c->set, q->saved, q->n_saved); /* groups that there were have room */
    changed_motion_undo(&q->changed);
    c->idle = q->idle;
    c->solved = NAN;
    q->n_saved = q->n_events = q->n_stops = 0;
}

/* ---- events ---- */

static dem_status hear(void *context, const dem_event *event)
{
    event_queue *q = context;
    CHECK(grow_array((void **)&q->events, &q->capacity, q->n_events + 1, sizeof *q->events), DEM_ERROR_MEMORY,
          "out of memory for the contact events of a step");
    q->events[q->n_events++] = *event;
    return DEM_OK;
}

static void look_again(event_queue *q, dem_index k)
{
    event_heap_set(&q->heap, k, automaton_next_change(q->automaton, q->step, k, q->now, q->state));
}

/* How far sites may go: some are faster now. */
static double furthest(const event_queue *q)
{
    const dense_output *step = q->step;
    const double *v1 = step->y1 + state_velocities(&step->layout);
    double way = q->automaton->way;
    for (dem_index j = 0; j < n_moving(q); j++) {
        const dem_index i = q->correction.near.nodes[j].i;
        if (q->automaton->set.of_node[i] < 0) continue;
        way = fmax(way, 2.0 * (step->t1 - step->t0) * vec2_norm(vec2_at(v1, i)));
    }
    return way;
}

/* By what the square of a velocity's error grows in a step that is longer by the ratio. A step that begins a time tau
 * after a jump estimates h^5 K^3 v (tau (1/104 - 1/120) - h/2080) for it, which vanishes for tau = 0.375 h; for
 * tau < h/4 it is a sixth of the error or more. */
static double growth(double ratio)
{
    const double third = ratio * ratio * ratio;
    return ratio < 4.0 ? third * third * third * third : 0.0;
}

/* What errors have left closed contacts near the event of velocities that they do not allow goes first: it would be
 * taken for sliding or for an approach. */
static void calm(event_queue *q)
{
    contact_set *c = &q->automaton->set;
    contact_instant now = {q->now, q->state, q->state + state_velocities(scene_layout(&c->scene)), NULL, DEM_OK};
    for (dem_index g = 0; g < q->correction.near.n_groups; g++)
        impact_group_stop(c, q->correction.near.groups[g].group, &now);
}

/* The nodes that an event may change at once, into `seeds`; there are *n. */
static dem_status find_seeds(event_queue *q, dem_index k, dem_index *n)
{
    *n = contact_set_seeds(&q->automaton->set, k, q->seeds, q->seed_capacity);
    if (*n <= q->seed_capacity) return DEM_OK;
    CHECK(grow_array((void **)&q->seeds, &q->seed_capacity, *n, sizeof *q->seeds), DEM_ERROR_MEMORY,
          "out of memory for what is near a contact");
    *n = contact_set_seeds(&q->automaton->set, k, q->seeds, q->seed_capacity);
    return DEM_OK;
}

/* What is due at a site, and what follows from it. */
static dem_status take(event_queue *q, dem_index k)
{
    const event_listener listener = {hear, q};
    automaton *c = q->automaton;
    dem_index n_seeds;
    double error;
    if (q->n_stops == 0) copy_books(&c->set.ledger, &q->ledger, c->set.scene.model->obstacles.n);
    q->n_stops += q->n_stops == 0 || q->heap.due[k] > q->now;
    q->now = q->heap.due[k];
    TRY(find_seeds(q, k, &n_seeds));
    TRY(local_correction_open(&q->correction, q->step, q->seeds, n_seeds, q->now, q->state));
    each_site(q, keep_site);
    calm(q);
    TRY(automaton_resolve_near(c, k, q->now, q->state, &listener));
    TRY(local_correction_close(&q->correction, q->step, &q->changed, q->state, &error));
    CHECK(isfinite(error), DEM_ERROR_INTEGRATOR,
          "the motion near node %lld after a contact event at t = %.9g s overflows", (long long)c->set.list[k].node,
          q->now);
    q->error += error;
    q->ahead += error * growth((q->step->t1 - q->step->t0) / q->correction.h);
    c->way = furthest(q);
    for (dem_index g = 0; g < q->correction.near.n_groups; g++)
        automaton_solve_group(c, q->step, q->correction.near.groups[g].group, q->state);
    each_site(q, look_again);
    return DEM_OK;
}

static bool has_moved(const event_queue *q, dem_index group)
{
    const contact_forces *r = &q->automaton->set.forces;
    for (dem_index m = contact_forces_first(r, group); m >= 0; m = r->next[m])
        if (changed_motion_has(&q->changed, r->candidates[m].node)) return true;
    return false;
}

/* Accelerations at the end of the step depend on the new positions of nodes and neighbours. */
static void renew(const event_queue *q, dem_index i, const double *y)
{
    const contact_set *c = &q->automaton->set;
    const unsigned held = q->correction.rule.held != NULL ? q->correction.rule.held[i] : 0;
    const double *v = y + state_velocities(scene_layout(&c->scene));
    double *a = q->changed.f1 + state_velocities(scene_layout(&c->scene));
    const bool grouped = contact_set_group_at(c, i) >= 0;
    const vec2 now =
        grouped ? vec2_at(c->forces.a, i) : forces_acceleration(c->scene.model, &c->scene.rule.load, i, y, v);
    if (!(held & DEM_COMPONENT_X)) a[2 * i] = now.x;
    if (!(held & DEM_COMPONENT_Y)) a[2 * i + 1] = now.y;
    if (held == 0) vec2_put(q->changed.f1, i, vec2_at(v, i));
}

/* The rates of the books that contacts fill, from all of them. */
static dem_status renew_books(event_queue *q)
{
    const state_layout *l = scene_layout(&q->automaton->set.scene);
    const dem_index first = state_impulse(l, 0), last = state_total_rows(l);
    double *a = q->changed.f1 + state_velocities(l);
    for (dem_index row = first; row <= last; row++) TRY(changed_motion_keep(&q->changed, row));
    for (dem_index k = state_row(l, first); k <= state_total_index(l, STATE_FRICTION); k++) a[k] = 0.0;
    automaton_add_rates(q->automaton, q->step->t1, q->changed.y1, a);
    return DEM_OK;
}

/* The same of a node whose motion has not changed. */
static dem_status renew_beside(event_queue *q, dem_index i, const double *y)
{
    if (changed_motion_has(&q->changed, i)) return DEM_OK;
    TRY(changed_motion_keep(&q->changed, i));
    renew(q, i, y);
    return DEM_OK;
}

/* Derivatives at the end of the step, for the change of nodes and contacts: they are those of the state to the bit, but
 * for the power of damping and boundaries. */
static dem_status renew_end(event_queue *q)
{
    contact_set *c = &q->automaton->set;
    const springs *s = &c->scene.model->springs;
    const triangles *t = &c->scene.model->triangles;
    const double *y1 = q->changed.y1;
    for (dem_index g = 0; g < c->forces.n_groups; g++)
        contact_forces_solve(&c->forces, c->forces.groups[g], scene_state_at(&c->scene, q->step->t1, y1));
    for (dem_index e = 0, n = q->changed.n; e < n; e++) {
        const dem_index i = q->changed.list[e].node;
        if (i >= c->scene.model->lattice.n_nodes) continue;
        renew(q, i, y1);
        for (dem_index p = s->row[i]; p < s->row[i + 1]; p++) TRY(renew_beside(q, s->neighbour[p], y1));
        for (dem_index p = t->row[i]; p < t->row[i + 1]; p++) {
            TRY(renew_beside(q, t->next[p], y1));
            TRY(renew_beside(q, t->last[p], y1));
        }
    }
    return renew_books(q);
}

/* The error that the patches leave in closed contacts goes: they are put back on their surfaces and stopped there. */
static dem_status settle_end(event_queue *q)
{
    contact_set *c = &q->automaton->set;
    double *y1 = q->changed.y1;
    contact_instant now = {q->step->t1, y1, y1 + state_velocities(scene_layout(&c->scene)), NULL, DEM_OK};
    for (dem_index g = 0; g < c->forces.n_groups; g++) {
        const dem_index group = c->forces.groups[g];
        if (!has_moved(q, group)) continue;
        (void)impact_group_project(c, group, &now);
        impact_group_stop(c, group, &now);
    }
    q->settled = true;
    return renew_end(q);
}

double event_queue_error(const event_queue *q)
{
    return isfinite(q->most) ? sqrt(q->error / q->most) : 0.0;
}

double event_queue_reach(const event_queue *q)
{
    const double error = isfinite(q->most) ? sqrt(q->ahead / q->most) : 0.0;
    return error > 1.0 ? (q->step->t1 - q->step->t0) / sqrt(sqrt(error)) : (double)INFINITY;
}

dem_status event_queue_show(event_queue *q, double t)
{
    const bool goes_back = t < q->now;
    if (goes_back && q->quiet) return DEM_OK;
    if (goes_back) {
        event_queue_undo(q);
        look_ahead(q);
    }
    for (dem_index k; (k = event_heap_first(&q->heap)) >= 0 && q->heap.due[k] <= t && q->error <= q->most;)
        TRY(take(q, k));
    q->now = t;
    if (t < q->step->t1) return DEM_OK;
    q->quiet = q->n_stops == 0;
    return q->quiet || q->settled ? DEM_OK : settle_end(q);
}
