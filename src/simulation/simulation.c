/* SPDX-License-Identifier: BSD-3-Clause */
/* The time loop, advance() at the end of this file. One round is
 * - take_step: an accepted step of the integrator with the contact events inside it; it is now *in hand*, as `path`;
 * - report_frames: observers see the frames that fall into it, read off its dense output;
 * - if t_end falls into it too, the advance ends and leaves the step in hand, with which the next advance goes on: no
 *   step is ever shortened for t_end or for a frame, so that a run in two parts has the bits of a run in one;
 * - commit_step: its end becomes the state. With `exact` contacts it ends at an event, which is resolved here (8)-(10).
 * If the user's force fails, the run goes back to the last state for which it was known (roll_back). The right-hand
 * side is in right_hand_side.c, what is seen of a run in query.c, checkpoints in checkpoint.c, set-up in setup.c. */
#include <stdio.h>

#include "base/reduce.h"
#include "base/status.h"
#include "contact/automaton_step.h"
#include "simulation/body_contact.h"
#include "simulation/breaking.h"
#include "simulation/checkpoint.h"
#include "simulation/guard_bound.h"
#include "simulation/led_run.h"
#include "simulation/likeness.h"
#include "simulation/pausing.h"
#include "simulation/query.h"
#include "simulation/shared_checkpoint.h"
#include "simulation/unseen_steps.h"

enum {
    between_looks = 16,       /* accepted steps, for overlaps */
    between_rare_looks = 256, /* the same where bodies touch each other and themselves, so that there should be none */
    most_attempts = 30        /* at a step whose contacts reject it */
};

/* Of the length of the next attempt at a step that contacts have rejected: never less than a tenth. */
static const double safety = 0.9, least_factor = 0.1; /* of the next step after one that contacts have rejected */

/* ---- calls of the observers ---- */

/* Makes the state after the last committed step the one that is seen by observers and callers. */
static dem_status show_state(dem_simulation *s)
{
    query_at(s, s->t, s->y);
    return query_ask(s);
}

/* The same of the state at a time within the step in hand. */
static dem_status show_inside(dem_simulation *s, double t)
{
    query_inside(s, t);
    return query_ask(s);
}

/* The listener for an event at which the whole body has stopped: the state is that right after this change, and others
 * may follow at the same time. */
static dem_status report_event(void *context, const dem_event *event)
{
    dem_simulation *s = context;
    TRY(show_state(s));
    return observers_event(&s->observers, s, event);
}

/* When the next event inside the step in hand that has still to be reported has happened; infinity: there is none. */
static double next_event(const dem_simulation *s)
{
    return s->n_reported < s->n_inside ? s->queue.events[s->n_reported].t : (double)INFINITY;
}

static double next_break(const dem_simulation *s)
{
    return s->n_known < s->n_broken ? s->breaks.breaks.list[s->n_known].t : (double)INFINITY;
}

static dem_status report_one_event(dem_simulation *s)
{
    const dem_event event = s->queue.events[s->n_reported++];
    TRY(show_inside(s, event.t));
    return observers_event(&s->observers, s, &event);
}

static dem_status report_one_break(dem_simulation *s)
{
    const dem_break what = break_list_at(&s->breaks.breaks, s->n_known++, s->model);
    TRY(show_inside(s, what.t));
    return observers_broken(&s->observers, s, &what);
}

/* Reports the events inside the step in hand, up to t, in the order of time, each with the state of its time: the queue
 * goes back there and on again. All of them are reported, and the first failure is returned. Contact comes first of
 * what happens at one time, as in the queue. */
static dem_status report_events(dem_simulation *s, double t)
{
    dem_status status = DEM_OK;
    if (!run_had_events(s)) return DEM_OK;
    if (!observers_want_events(&s->observers)) s->n_reported = s->n_inside;
    if (!observers_want_breaks(&s->observers)) s->n_known = s->n_broken;
    while (fmin(next_event(s), next_break(s)) <= t) {
        const bool contact = next_event(s) <= next_break(s);
        status = status_first(status, contact ? report_one_event(s) : report_one_break(s));
        if (run_force_failed(s)) break;
    }
    return reduce_status(s->model->ranks, status, 0.0);
}

/* What has broken at the end of a step that a break has ended, or by the program, is reported with that state. */
static dem_status report_breaks(dem_simulation *s, const break_list *breaks, dem_index from)
{
    const bool wanted = observers_want_breaks(&s->observers); /* of this rank */
    if (from == breaks->n) return DEM_OK;
    dem_status status = wanted ? show_state(s) : DEM_OK;
    for (dem_index k = from; k < breaks->n && wanted; k++) {
        const dem_break what = break_list_at(breaks, k, s->model);
        status = status_first(status, observers_broken(&s->observers, s, &what));
    }
    return reduce_status(s->model->ranks, status, 0.0);
}

/* Which fragments have come of what has broken by itself, before anybody goes back to the instants of these breaks. */
static void find_split(dem_simulation *s, dem_index from)
{
    if (observers_want_breaks(&s->observers)) break_list_find_split(&s->breaks.breaks, from, s->model, &s->elements);
}

static dem_status report_own_breaks(dem_simulation *s, dem_index from)
{
    find_split(s, from);
    return report_breaks(s, &s->breaks.breaks, from);
}

/* Notes what observers have returned for a step: ranks tell each other about it at the end of the next attempt. */
static void note_stop(run_stop *stop, dem_status status)
{
    if (status == DEM_OK || stop->status != DEM_OK) return;
    stop->status = status;
    (void)snprintf(stop->message, sizeof stop->message, "%s", dem_status_message());
}

/* Whether observers of some rank have stopped the run at the last step. A step from there is then in hand already, with
 * which the next advance goes on. */
static dem_status take_stop(dem_simulation *s)
{
    const dem_status own = s->stop.status;
    if (!s->stop.is_known) return DEM_OK;
    if (own != DEM_OK) (void)status_fail(own, "%s", s->stop.message);
    s->stop = (run_stop){0};
    return reduce_status(s->model->ranks, own, 0.0);
}

/* Whether contacts with obstacles have changed in the step that was taken last. */
static bool has_contact_events(const dem_simulation *s)
{
    return s->n_inside > 0 || s->at_event;
}

/* Of rigid bodies that is not asked. */
bool run_touches(const dem_simulation *s)
{
    if (has_contact_events(s) || s->automaton.set.forces.n_groups > 0 || s->rigid != NULL) return true;
    return s->surfaces != NULL && query_surfaces(s)->pushing > 0;
}

/* Every accepted step, after its contacts have changed, or the last of those that were taken at once. */
static dem_status report_step(dem_simulation *s)
{
    TRY(show_state(s));
    const accepted_step step = {run_count_steps(s), s->t, observers_want_touching(&s->observers) && run_touches(s)};
    const dem_status status = observers_step(&s->observers, s, &step);
    if (!run_is_shared(s) || s->is_led) return status; /* which all ranks have alike */
    note_stop(&s->stop, status);
    return DEM_OK;
}

/* Shows the state from which the step in hand goes, if contacts change in it, once. That step has been counted
 * already. */
static dem_status report_before_touching(dem_simulation *s)
{
    const accepted_step before = {run_count_steps(s) - 1, s->t, false};
    if (!has_contact_events(s) || !observers_want_touching(&s->observers)) return DEM_OK;
    query_at(s, s->t, s->y);
    s->measures->has_events = !run_is_local(s);
    TRY(query_ask(s));
    return reduce_status(s->model->ranks, observers_before_touching(&s->observers, s, &before), 0.0);
}

/* Shows the frames up to the end of the step and t_end in the order of time; events before a frame come before it. */
static dem_status report_frames(dem_simulation *s, double t_end)
{
    double t;
    for (int k = 0; (k = observers_due(&s->observers, s->path.end, t_end, &t)) >= 0;) {
        TRY(report_events(s, t));
        TRY(show_inside(s, t));
        TRY(reduce_status(s->model->ranks, observers_frame(&s->observers, k, s), 0.0));
    }
    return DEM_OK;
}

/* ---- the loop ---- */

/* If the user's force has failed, DEM_STOPPED, so that the advance ends and rolls back: all since was computed with a
 * force of 0. */
static dem_status stop_if_force_failed(const dem_simulation *s, dem_status status)
{
    return run_force_failed(s) ? DEM_STOPPED : status;
}

/* Takes a checkpoint before contacts change at once, in case the external force fails meanwhile: such changes are not
 * undone otherwise, whereas a step is given up by starting it again. */
static dem_status take_rollback(dem_simulation *s)
{
    if (s->external == NULL && !s->model->obstacles.is_asked) return DEM_OK;
    if (s->rollback == NULL) TRY(dem_checkpoint_create(&s->rollback));
    TRY(checkpoint_take(s, s->rollback));
    s->has_rollback = true;
    return DEM_OK;
}

/* Goes back to the last state for which the external force was known: that of the rollback point, if contacts were
 * changing, else the start of the step. The failure itself is returned with its own message. Motions of obstacles are
 * asked for again at that state, so that its contacts are known; if that fails, too, none are listed. */
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
    status = status_first(status, body_contact_follow(s, s->y));
    status = status_first(status, run_force_failure(s));
    query_at(s, s->t, s->y);
    query_ask_poses(s);
    if (run_force_failed(s)) {
        (void)run_force_failure(s);
        query_at(s, s->t, s->y);
    }
    return status;
}

/* Factor by which the next attempt at a step is shorter, 1 if the step is good or shortening does not help. The error
 * of its events goes with the fourth power of its length at least: 0.9/error^(1/4). Events may fail if the step is much
 * too long, and then it is tried with a tenth. */
static double shortening(const dem_simulation *s, dem_status status)
{
    const double error = run_is_local(s) ? event_queue_error(&s->queue) : 0.0;
    if (status == DEM_ERROR_CONTACT || status == DEM_ERROR_INTEGRATOR) return least_factor;
    return status == DEM_OK && error > 1.0 ? fmax(least_factor, safety / sqrt(sqrt(error))) : 1.0;
}

/* Gives up a step that cannot be taken: the integrator is back at its start, and the last good state stays in force, of
 * which no residual is known any more. */
static dem_status give_up(dem_simulation *s, dem_status status)
{
    s->path.f1 = NULL;
    if (status == DEM_OK)
        status = status_fail(DEM_ERROR_INTEGRATOR,
                             "contact events in the step from t = %.9g s fail its error test: rtol may be out of reach",
                             s->t);
    status = status_first(status, body_contact_follow(s, s->y));
    return status_first(status, integrator_restart(&s->integrator, s->t, s->y));
}

/* Finds the contact events in the step just taken. With `local` they are resolved and corrected inside it, to its end.
 * With `exact` it ends at the first: at a root of the integrator (`rooted`), or where the check finds an event before
 * it. Then surfaces of bodies must not have crossed. Ranks have the same events; forces on the last of their common
 * nodes are computed again where ghosts are at the end of the step. */
static dem_status find_events(dem_simulation *s, bool rooted)
{
    double *y1, *f1;
    if (!run_is_local(s)) {
        s->at_event = automaton_check_step(&s->automaton, &s->path, rooted, s->frame) || rooted;
        breaking_check_step(s);
        TRY(breaking_found(s));
        return body_contact_check_step(s);
    }
    integrator_end(&s->integrator, &y1, &f1);
    event_queue_start(&s->queue, &s->path, y1, f1, s->frame);
    if (run_is_shared(s) && event_queue_has_event(&s->queue)) s->shared.fill_ghosts(y1, s);
    TRY(event_queue_show(&s->queue, s->path.t1));
    TRY(breaking_found(s));
    return body_contact_check_step(s);
}

/* The status of a step, unless there was no memory for the contact of bodies in it. */
static dem_status unless_memory_lacked(const dem_simulation *s, dem_status status)
{
    CHECK(body_contact_failure(s) != DEM_ERROR_MEMORY, DEM_ERROR_MEMORY,
          "out of memory for the contact of bodies in the step from t = %.9g s", s->t);
    return status;
}

/* A step with its contact events, which may reject it after the integrator has accepted it: an error of theirs is
 * unknown to the integrator. The queue then takes them back, and the integrator tries again from the same start with a
 * shorter step. Fixed steps cannot be shortened. */
static dem_status take_step(dem_simulation *s)
{
    TRY(likeness_check_motions(s, s->t + s->options.max_step));
    for (int attempt = 1;; attempt++) {
        bool rooted;
        body_contact_begin_step(s);
        guard_bound_begin_step(s);
        const dem_status taken = unless_memory_lacked(s, integrator_step(&s->integrator, &s->path, &rooted));
        if (taken == DEM_ERROR_MEMORY) return give_up(s, taken);
        TRY(taken);
        const dem_status found = stop_if_force_failed(s, find_events(s, rooted));
        const dem_status status = unless_memory_lacked(s, found);
        const double factor = shortening(s, status);
        if (status == DEM_OK && factor == 1.0) break;
        event_queue_undo(&s->queue);
        if (s->options.fixed_step > 0.0 || attempt == most_attempts || factor == 1.0) return give_up(s, status);
        TRY(integrator_redo(&s->integrator, factor));
    }
    /* Events have been found to the end of the step, but observers know of none of them yet. */
    s->n_inside = s->queue.n_events;
    s->n_broken = run_is_local(s) ? s->breaks.breaks.n : 0;
    s->n_reported = s->n_known = 0;
    s->in_hand = true;
    if (s->n_broken > 0) find_split(s, 0);
    return DEM_OK;
}

/* Restarts the integrator after the contacts of the state have changed, with this status, and v has jumped. The
 * rollback point is no longer needed once the force has not failed. After a contact error the step is not reported. */
static dem_status go_on(dem_simulation *s, dem_status status)
{
    TRY(stop_if_force_failed(s, DEM_OK));
    s->has_rollback = false;
    body_contact_begin_anew(s);
    status = status_first(status, integrator_restart(&s->integrator, s->t, s->y));
    return status == DEM_ERROR_CONTACT ? status : status_first(status, report_step(s));
}

/* Overlaps of bodies are only reported, not resolved: a look now and then is enough. Of ghosts only positions count. */
static void look_for_overlaps(dem_simulation *s)
{
    if (run_is_shared(s) && overlap_is_possible(&s->overlap)) halo_exchange(&s->halo, &s->y, 1);
    overlap_look(&s->overlap, &s->model->lattice, s->t, s->y);
    s->unlooked = 0;
}

/* Steps until the next look. */
static int left_to_look(const dem_simulation *s)
{
    return (s->options.bodies == DEM_BODIES_ALL ? between_rare_looks : between_looks) - s->unlooked;
}

/* Steps whose end is the state now. */
static void count_steps(dem_simulation *s, int n)
{
    s->since_checkpoint += n;
    s->unlooked += n;
    if (left_to_look(s) <= 0) look_for_overlaps(s);
}

/* Makes the end of the step the state of the integrator, in which rigid bodies have their shapes. After a whole step
 * the derivative is that of this state; one that was cut short is followed by a restart. */
static void accept_end(dem_simulation *s)
{
    const dense_output *p = &s->path;
    const rigid_bodies *rigid = &s->model->rigid;
    const dem_index v = state_velocities(&s->layout);
    double *y1, *f1;
    if (p->end == p->t1 && rigid->n > 0) {
        integrator_end(&s->integrator, &y1, &f1);
        rigid_motion_put_back_end(rigid, run_keeps(s), (double *[]){y1, y1 + v}, (double *[]){f1, f1 + v});
    }
    integrator_settle(&s->integrator, p);
    s->y = integrator_state(&s->integrator);
    if (p->end < p->t1) rigid_motion_put_back(rigid, run_keeps(s), s->y, s->y + v);
}

/* Makes the end of the step in hand the state: the integrator accepts it, closed contacts that have opened are put
 * back, and forces and clearances are those of the new state.  \return whether vertex contacts were put back */
static bool settle_step(dem_simulation *s)
{
    const dense_output *p = &s->path;
    accept_end(s);
    const bool moved = automaton_project(&s->automaton, p->end, s->y);
    automaton_end_step(&s->automaton, p, s->y);
    s->step = p->end - s->t;
    s->t = p->end;
    s->in_hand = false;
    count_steps(s, 1);
    return moved;
}

/* The end of the step is an event of `exact`: the contacts change, the velocities jump, and the integrator starts
 * anew. */
static dem_status resolve_event(dem_simulation *s)
{
    const event_listener listener = {report_event, s};
    s->events++;
    return go_on(
        s, reduce_status(s->model->ranks, automaton_resolve(&s->automaton, s->t, s->y, &listener), 0.0)); /* (8), (9) */
}

/* Contacts of edges that have broken away in the step end with it. */
static dem_status release_orphans(dem_simulation *s)
{
    const event_listener listener = {report_event, s};
    if (s->automaton.set.n_orphans == 0) return DEM_OK;
    return reduce_status(s->model->ranks, automaton_release_orphans(&s->automaton, s->t, s->y, &listener), 0.0);
}

/* Lets the integrator go on from the end of the step. If contacts were put back or surfaces have met (`moved`), the
 * derivative there is unknown: it starts anew. If events have changed the end and its derivative, it resumes from both
 * without an evaluation, with a step bounded for what their error would be in it; likewise if rigid bodies have got
 * their shapes back. Otherwise nothing has changed. */
static dem_status go_on_changed(dem_simulation *s, bool moved)
{
    if (run_is_local(s)) TRY(integrator_bound(&s->integrator, event_queue_reach(&s->queue)));
    const bool changed = run_had_events(s) || s->model->rigid.n > 0;
    if (moved || changed) body_contact_begin_anew(s);
    if (moved) return integrator_restart(&s->integrator, s->t, s->y);
    return changed ? integrator_resume(&s->integrator) : DEM_OK;
}

/* Events compute the derivative at the end again node by node, and not that of a rigid body. */
static bool events_moved_rigid(const dem_simulation *s)
{
    return s->model->rigid.n > 0 && run_had_events(s);
}

/* Whether elements may have broken in the step: as events, or with `exact` at its end. */
static bool may_have_broken(const dem_simulation *s)
{
    return run_may_break(s) && (run_had_events(s) || !run_is_local(s));
}

/* Reports the events left in the step, takes the queue to its end, as observers may have left it at an earlier time,
 * and makes the end the state. */
static dem_status commit_step(dem_simulation *s)
{
    TRY(report_events(s, s->path.t1));
    if (run_is_local(s)) TRY(stop_if_force_failed(s, event_queue_show(&s->queue, s->path.t1)));
    if (s->at_event) TRY(take_rollback(s));
    const bool breaks = may_have_broken(s);
    if (breaks) TRY(breaking_end_step(s));
    /* From here on the end of the step is the state: y and t. */
    const bool broken = breaks && fracture_source_has_broken(&s->breaks);
    const bool failed = breaks && fracture_source_has_failed(&s->breaks);
    const bool moved = settle_step(s), paused = pausing_end_step(s, broken);
    body_contact_end_step(s);
    guard_bound_end_step(s);
    TRY(body_contact_settle(s, s->y));
    if (s->at_event) return resolve_event(s);
    s->events += (run_had_events(s) ? s->queue.n_taken : 0) + s->at_break;
    TRY(go_on_changed(s, moved || failed || paused || s->outgrown || events_moved_rigid(s)));
    dem_status reported = report_own_breaks(s, s->n_broken);
    reported = status_first(reported, release_orphans(s));
    return status_first(reported, report_step(s));
}

/* Closes the contacts of the initial state before the first step, and gives bodies that touch their friction, when the
 * observers are there to be called. If the external force fails here, the next advance starts again. */
static dem_status start(dem_simulation *s)
{
    const event_listener listener = {report_event, s};
    TRY(likeness_check_force(s));
    TRY(breaking_begin(s));
    TRY(body_contact_settle(s, s->y));
    const dem_status given = report_breaks(s, &s->given, 0), own = report_own_breaks(s, 0);
    s->given.n = 0;
    TRY(status_first(given, own));
    TRY(take_rollback(s));
    const dem_status status =
        go_on(s, reduce_status(s->model->ranks, automaton_start(&s->automaton, s->t, s->y, &listener), 0.0));
    s->started = !run_force_failed(s);
    return status;
}

/* By accepted steps, not by time: where a run is cut must not matter. The first is due at once. */
static bool wants_checkpoint(const dem_simulation *s)
{
    const dem_index every = s->options.checkpoint_steps;
    return every > 0 && (!s->has_checkpoint || s->since_checkpoint >= every);
}

/* Takes a checkpoint and goes on from it. Whatever it does not hold is computed anew, here as in a run that is resumed
 * from it. So both have the same bits, whether or not the checkpoint is ever written. */
static dem_status take_checkpoint(dem_simulation *s)
{
    s->has_checkpoint = false;
    TRY(checkpoint_take(s, s->checkpoint));
    TRY(checkpoint_restore(s, s->checkpoint));
    if (s->model->domain != NULL) TRY(shared_checkpoint_gather(s, s->checkpoint));
    s->has_checkpoint = true;
    TRY(show_state(s));
    return reduce_status(s->model->ranks, observers_checkpoint(&s->observers, s, s->checkpoint), 0.0);
}

/* Takes several steps at once, between which nobody looks at anything, if there are as many before the next checkpoint,
 * frame, look, or t_end. Nothing has touched in them.  \return whether it has */
static bool take_unseen(dem_simulation *s, double t_end)
{
    const dem_index every = s->options.checkpoint_steps,
                    left = every > 0 ? every - s->since_checkpoint : left_to_look(s);
    const int n = unseen_steps_take(s, left < left_to_look(s) ? (int)left : left_to_look(s), t_end);
    if (n == 0) return false;
    s->n_inside = s->n_reported = 0;
    count_steps(s, n);
    return true;
}

/* Steps until t_end falls into the step in hand; then shows the state there. The next advance may find the step in
 * hand. */
static dem_status advance(dem_simulation *s, double t_end)
{
    if (!s->started) TRY(start(s));
    for (;;) {
        if (!s->in_hand && wants_checkpoint(s)) TRY(take_checkpoint(s));
        if (!s->in_hand && take_unseen(s, t_end)) {
            TRY(report_step(s));
            continue;
        }
        const dem_status taken = s->in_hand ? DEM_OK : take_step(s);
        TRY(status_first(take_stop(s), taken));
        TRY(report_before_touching(s));
        TRY(stop_if_force_failed(s, report_frames(s, t_end)));
        if (t_end < s->path.end) break;
        TRY(commit_step(s));
    }
    TRY(report_events(s, t_end));
    return show_inside(s, t_end);
}

/* A failed force ends the advance in any case, even if a later error has come first. */
dem_status dem_simulation_advance(dem_simulation *s, double t_end)
{
    CHECK(s != NULL, DEM_ERROR_ARGUMENT, "dem_simulation_advance: simulation is NULL");
    CHECK(s->leads != NULL || s->model->part == NULL, DEM_ERROR_ARGUMENT,
          "dem_simulation_advance: ranks have the parts of the model, and do not make the run");
    CHECK(isfinite(t_end) && t_end >= s->seen_t, DEM_ERROR_ARGUMENT, "t_end = %g s is before the present time %g s",
          t_end, s->seen_t);
    s->advanced = s->advancing = true;
    const dem_status status = s->leads != NULL ? led_run_advance(s, t_end) : advance(s, t_end);
    s->advancing = false;
    return run_force_failed(s) ? roll_back(s) : status;
}
