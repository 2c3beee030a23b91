/* SPDX-License-Identifier: BSD-3-Clause */
/* Of the whole's state only what is asked for is gathered. What an observer returns is the status of all ranks, so that
 * a run stops at once, as that of a process alone. */
#include "simulation/leader_observers.h"

#include "base/checkpoint_entries.h"
#include "base/status.h"
#include "simulation/leader_checkpoint.h"
#include "simulation/rank_call.h"

void leader_observers_show(const led_run *l)
{
    dem_simulation *whole = l->whole;
    whole->t = l->part->t;
    whole->step = l->part->step;
    whole->seen_t = l->part->seen_t;
    whole->seen = whole->frame;
    *whole->measures = (run_measures){.has_events = true};
}

/* Rank 0 is by itself while it calls its observers. */
static led_run *hold(led_run *l)
{
    led_ranks_leave(l);
    leader_observers_show(l);
    return l;
}

static dem_status release(led_run *l, dem_status status)
{
    (void)rank_call_send(&l->ranks, (rank_call){.kind = RANK_CALL_GO_ON, .number = (dem_index)status});
    led_ranks_enter(l);
    return status;
}

static dem_status lead_step(void *context, const dem_simulation *part)
{
    if (led_ranks_have_seen_step(context, part)) return DEM_OK;
    led_run *l = hold(context);
    observers *a = &l->whole->observers;
    const accepted_step step = {run_count_steps(part), part->t, observers_want_touching(a) && run_touches(part)};
    return release(l, observers_step(a, l->whole, &step));
}

static dem_status lead_before(void *context, const dem_simulation *part)
{
    if (!led_ranks_are_before(context, part)) return DEM_OK;
    led_run *l = hold(context);
    const accepted_step before = {run_count_steps(part) - 1, part->t, false};
    return release(l, observers_before_touching(&l->whole->observers, l->whole, &before));
}

static dem_status lead_event(void *context, const dem_simulation *part, const dem_event *event)
{
    (void)part;
    if (led_ranks_have_seen(context)) return DEM_OK;
    led_run *l = hold(context);
    return release(l, observers_event(&l->whole->observers, l->whole, event));
}

static dem_status lead_break(void *context, const dem_simulation *part, const dem_break *what)
{
    (void)part;
    if (led_ranks_have_seen(context)) return DEM_OK;
    led_run *l = hold(context);
    return release(l, observers_broken(&l->whole->observers, l->whole, what));
}

static dem_status lead_frame(void *context, const dem_simulation *part)
{
    const frame_relay *f = context;
    (void)part;
    if (led_ranks_have_seen(f->run)) return DEM_OK;
    led_run *l = hold(f->run);
    return release(l, observers_frame(&l->whole->observers, f->observer, l->whole));
}

static dem_status take_checkpoint(led_run *l, dem_checkpoint *from)
{
    dem_simulation *whole = l->whole;
    whole->has_checkpoint = false;
    TRY(leader_checkpoint_take(l, from));
    whole->has_checkpoint = true;
    return observers_checkpoint(&whole->observers, whole, whole->checkpoint);
}

dem_status leader_observers_look_ahead(led_run *l, const dem_checkpoint *checkpoint)
{
    const dem_lattice *lattice = &l->whole->model->lattice;
    near_contact_state state = {l->whole->t, lattice->position, lattice->velocity};
    size_t size;
    if (l->near.model == NULL) return DEM_OK; /* or a checkpoint's state would be gathered for nothing */
    if (checkpoint != NULL) {
        TRY(checkpoint_entries_check(checkpoint, "state", (size_t)state_size(&l->whole->layout) * sizeof *state.x));
        state.x = dem_checkpoint_find(checkpoint, "state", &size);
        if (state.x == NULL) return DEM_ERROR_MEMORY; /* or DEM_ERROR_IO, as the message says */
        state.v = state.x + state_velocities(&l->whole->layout);
    }
    near_contact_look(&l->near, &state);
    return DEM_OK;
}

/* A part goes on from a checkpoint as one does that begins there: so nodes may be shared out anew, or other ones be
 * common, for which the advance of all parts stops. */
static dem_status lead_checkpoint(void *context, const dem_simulation *part, dem_checkpoint *checkpoint)
{
    led_run *l = context;
    const bool pays = led_ranks_collect_busy(l) && balance_pays(&l->balance);
    (void)part;
    (void)hold(l);
    led_ranks_pass_checkpoint(l);
    dem_status status = take_checkpoint(l, checkpoint);
    if (status == DEM_OK) status = leader_observers_look_ahead(l, l->whole->checkpoint);
    l->weighs_anew = status == DEM_OK && pays;
    l->shares_anew =
        l->weighs_anew || (status == DEM_OK && near_contact_is_outdated(&l->near, l->busy, l->balance.price));
    return release(l, l->shares_anew ? DEM_STOPPED : status);
}

const led_observers leader_observers = {.step = lead_step,
                                        .before = lead_before,
                                        .event = lead_event,
                                        .broken = lead_break,
                                        .frame = lead_frame,
                                        .checkpoint = lead_checkpoint};
